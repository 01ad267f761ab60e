// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "bim/geometry/grid_frame.h"
#include "slam/plan_map/plan_segment.h"

namespace plumbline::slam {

/// Grows from 0 to 4 over a turn, by 2 over half of one; 0 along x.
[[nodiscard]] inline double pseudo_angle(const Eigen::Vector2d& d) {
  const double p = d.y() / (std::abs(d.x()) + std::abs(d.y()));
  return d.x() < 0.0 ? 2.0 - p : d.y() < 0.0 ? 4.0 + p : p;
}

/// For each cell and range of directions (none for plans of more than most_cells): the faces that a ray from there may
/// hit, nearest first, up to a distance by which it has nearly always hit one. A ray is then tested against two or
/// three faces, not against all along it.
class RayCandidateTable {
 public:
  static constexpr std::size_t most_cells = 100'000;  ///< 25,000 m^2 of 0.5 m; lists of 2 kB a cell, 8 kB at most

  static constexpr int azimuth_bins_per_quadrant = 12;
  static constexpr int azimuth_bins_per_turn = 4 * azimuth_bins_per_quadrant;

  /// A face, and a distance before which no ray of the list hits it. The last entry has no face (-1), and the distance
  /// up to which the list is complete.
  struct Entry {
    int segment = -1;
    float from = 0.0F;
  };

  RayCandidateTable() = default;
  RayCandidateTable(const std::vector<PlanSegment>& segments, const GridFrame& frame);

  /// First hit as SegmentGrid::cast gives it, to the bit; false where the list does not reach far enough, `best` is
  /// then of no use. best: what is to be beaten.
  [[nodiscard]] bool cast(const std::vector<PlanSegment>& segments, int cell, const PlanRay& ray, PlanHit& best) const {
    if (first_.empty()) return false;
    for (const Entry* entry = list(cell, azimuth_bin_of(ray.direction));
         static_cast<double>(entry->from) <= best.distance; ++entry) {
      const int i = entry->segment;
      if (i < 0) return false;
      keep_nearest(segments[static_cast<std::size_t>(i)], i, ray, best);
    }
    return true;
  }

  /// Whether the ray passes through a hole of a face between two horizontal distances; none where the list does not
  /// reach far enough.
  [[nodiscard]] std::optional<bool> crosses_opening(const std::vector<PlanSegment>& segments, int cell,
                                                    const PlanRay& ray, double from, double to) const {
    if (first_.empty()) return std::nullopt;
    for (const Entry* entry = list(cell, azimuth_bin_of(ray.direction)); static_cast<double>(entry->from) <= to;
         ++entry) {
      if (entry->segment < 0) return std::nullopt;
      const PlanSegment& segment = segments[static_cast<std::size_t>(entry->segment)];
      if (segment.holes.empty()) continue;
      const double t = plane_distance(segment, ray);
      if (t > from && t <= to && part_at(segment, ray, t) == FacePart::hole) return true;
    }
    return false;
  }

  /// Distance before which no ray from the cell hits a face.
  [[nodiscard]] double clearance(int cell) const;
  [[nodiscard]] bool empty() const { return first_.empty(); }
  /// Range of directions of a ray.
  [[nodiscard]] static int azimuth_bin_of(const Eigen::Vector2d& direction) {
    return static_cast<int>(std::min(azimuth_bins_per_quadrant * pseudo_angle(direction), azimuth_bins_per_turn - 0.5));
  }
  [[nodiscard]] const Entry* list(int cell, int bin) const {
    return &entries_[static_cast<std::size_t>(first_[static_cast<std::size_t>(cell * azimuth_bins_per_turn + bin)])];
  }

 private:
  struct Bin;
  void fill_cell(const std::vector<PlanSegment>& segments, const Eigen::Vector2d& center, double cell,
                 const std::vector<Entry>& by_distance, std::vector<Bin>& bins);

  std::vector<int> first_;  ///< by cell and direction: start of its list
  std::vector<Entry> entries_;
};

}  // namespace plumbline::slam
