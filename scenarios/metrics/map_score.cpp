// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/map_score.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bim/errors.h"
#include "scenarios/host/interrupt.h"

namespace plumbline::scenarios::score {

namespace {

/// Points sorted by the cell they lie in, so that neighbours are found by binary search.
class PointCells {
 public:
  PointCells(const std::vector<Eigen::Vector3d>& points, double size) : size_(size) {
    entries_.reserve(points.size());
    for (const Eigen::Vector3d& p : points) entries_.push_back({cell_of(p), p});
    std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.cell < b.cell; });
  }

  /// True when a point lies within the cell size of p.
  [[nodiscard]] bool near(const Eigen::Vector3d& p) const {
    const Cell center = cell_of(p);
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy) {
        const Cell first{center[0] + dz, center[1] + dy, center[2] - 1};
        const Cell last{first[0], first[1], center[2] + 1};
        auto it = std::lower_bound(entries_.begin(), entries_.end(), first,
                                   [](const Entry& entry, const Cell& cell) { return entry.cell < cell; });
        for (; it != entries_.end() && it->cell <= last; ++it)
          if ((it->p - p).norm() <= size_) return true;
      }
    return false;
  }

 private:
  /// (z, y, x), so that one row along x is one stretch of the sorted array.
  using Cell = std::array<int, 3>;
  struct Entry {
    Cell cell;
    Eigen::Vector3d p;
  };
  [[nodiscard]] Cell cell_of(const Eigen::Vector3d& p) const {
    const auto cell = [&](double x) { return static_cast<int>(std::clamp(std::floor(x / size_), -1e9, 1e9)); };
    return {cell(p.z()), cell(p.y()), cell(p.x())};
  }

  double size_;
  std::vector<Entry> entries_;
};

}  // namespace

double completeness(const std::vector<Eigen::Vector3d>& surface, const std::vector<Eigen::Vector3d>& map,
                    double within_m) {
  if (surface.empty()) throw InternalError("score: no surface was hit");
  const PointCells cells(map, within_m);
  const auto mapped = std::count_if(surface.begin(), surface.end(), [&](const auto& p) { return cells.near(p); });
  return static_cast<double>(mapped) / static_cast<double>(surface.size());
}

MapScore score_map(const std::vector<Eigen::Vector3f>& map_F, const Pose& X_WF, const SurfaceDistance& distance,
                   const std::vector<Eigen::Vector3d>& surface_W, const MapRules& rules) {
  if (map_F.empty()) throw InternalError("score: the map is empty");
  std::vector<Eigen::Vector3d> map_W;
  map_W.reserve(map_F.size());
  double sum = 0.0;
  std::size_t capped = 0;
  for (const Eigen::Vector3f& p_F : map_F) {
    const Eigen::Vector3d p_W = X_WF * p_F.cast<double>();
    const double d = std::min(distance(p_W), rules.cap_m);
    sum += d * d;
    if (d >= rules.cap_m) ++capped;
    map_W.push_back(p_W);
    constexpr std::size_t often = 10'000;  // a large map takes minutes
    if (map_W.size() % often == 0) check_interrupt();
  }
  const auto n = static_cast<double>(map_F.size());
  return {std::sqrt(sum / n), static_cast<double>(capped) / n, completeness(surface_W, map_W, rules.complete_within_m)};
}

}  // namespace plumbline::scenarios::score
