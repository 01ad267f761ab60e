// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/segment_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace plumbline::slam {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Marches a ray through square cells.
struct GridWalk {
  std::array<int, 2> cell{};
  std::array<int, 2> step{};
  std::array<double, 2> next{};   ///< distance at which the ray leaves the cell, per axis
  std::array<double, 2> delta{};  ///< distance per cell, per axis

  GridWalk(const Eigen::Vector2d& local, const Eigen::Vector2d& direction, double size) {
    for (int k = 0; k < 2; ++k) {
      const auto i = static_cast<std::size_t>(k);
      cell[i] = static_cast<int>(std::floor(local[k] / size));
      step[i] = direction[k] > 0.0 ? 1 : -1;
      const double border = size * (cell[i] + (direction[k] > 0.0 ? 1 : 0));
      const bool still = std::abs(direction[k]) < 1e-12;
      next[i] = still ? infinity : (border - local[k]) / direction[k];
      delta[i] = still ? infinity : size / std::abs(direction[k]);
    }
  }

  [[nodiscard]] double exit() const { return std::min(next[0], next[1]); }

  void advance() {
    const std::size_t i = next[0] <= next[1] ? 0 : 1;
    cell[i] += step[i];
    next[i] += delta[i];
  }
};

}  // namespace

SegmentGrid::SegmentGrid(const std::vector<PlanSegment>& segments, double cell_m) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(infinity);
  Eigen::Vector2d high = -low;
  for (const PlanSegment& segment : segments) {
    const Eigen::Vector2d b = segment.a + segment.length * segment.e;
    low = low.cwiseMin(segment.a).cwiseMin(b);
    high = high.cwiseMax(segment.a).cwiseMax(b);
  }
  if (segments.empty()) low = high = Eigen::Vector2d::Zero();
  const auto across = [&](int axis) { return std::ceil((high[axis] - low[axis]) / cell_m) + 2.0; };
  while (across(0) * across(1) > static_cast<double>(RayCandidateTable::most_cells)) cell_m *= 2.0;
  frame_ = {low.array() - cell_m, cell_m, static_cast<int>(across(0)), static_cast<int>(across(1))};
  fill(segments);
  ray_candidates_ = RayCandidateTable(segments, frame_);
  for (int cell = 0; cell < cells(); ++cell) clearance_.push_back(ray_candidates_.clearance(cell));
}

void SegmentGrid::fill(const std::vector<PlanSegment>& segments) {
  std::vector<std::vector<int>> lists(static_cast<std::size_t>(cells()));
  // A face is listed in every cell it comes within a hair of, so that rounding at cell borders loses nothing.
  const double reach = 0.5 * frame_.cell + 1e-6;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const PlanSegment& segment = segments[i];
    for (int cell = 0; cell < cells(); ++cell) {
      const Eigen::Vector2d to_center = cell_center(cell) - segment.a;
      const double across = std::abs(to_center.dot(segment.n));
      if (across > reach * (std::abs(segment.n.x()) + std::abs(segment.n.y()))) continue;
      const double along = to_center.dot(segment.e);
      const double slack = reach * (std::abs(segment.e.x()) + std::abs(segment.e.y()));
      if (along < -slack || along > segment.length + slack) continue;
      lists[static_cast<std::size_t>(cell)].push_back(static_cast<int>(i));
    }
  }
  first_.assign(1, 0);
  for (const std::vector<int>& list : lists) {
    items_.insert(items_.end(), list.begin(), list.end());
    first_.push_back(static_cast<int>(items_.size()));
  }
}

PlanHit SegmentGrid::search(const std::vector<PlanSegment>& segments, const PlanRay& ray, double max_distance) const {
  PlanHit best{max_distance, -1};
  march(
      ray,
      [&](int i) {
        keep_nearest(segments[static_cast<std::size_t>(i)], i, ray, best);
        return best.distance;
      },
      max_distance);
  return best;
}

bool SegmentGrid::crosses_opening(const std::vector<PlanSegment>& segments, const PlanRay& ray, double from, double to,
                                  int cell) const {
  if (cell >= 0)
    if (const std::optional<bool> crosses = ray_candidates_.crosses_opening(segments, cell, ray, from, to))
      return *crosses;
  const PlanRay rest{ray.origin + from * ray.direction, ray.direction, ray.z + from * ray.slope, ray.slope};
  bool found = false;
  march(
      rest,
      [&](int i) {
        const PlanSegment& segment = segments[static_cast<std::size_t>(i)];
        const double t = plane_distance(segment, rest);
        found = found || (t <= to - from && part_at(segment, rest, t) == FacePart::hole);
        return found ? 0.0 : to - from;
      },
      to - from);
  return found;
}

template <class Visit>
void SegmentGrid::march(const PlanRay& ray, Visit visit, double reach) const {
  const int nx = frame_.nx, ny = frame_.ny;
  GridWalk walk(ray.origin - frame_.origin, ray.direction, frame_.cell);
  for (double entry = 0.0; entry < reach; walk.advance()) {
    const double exit = walk.exit();
    const auto [x, y] = walk.cell;
    if (x < 0 || y < 0 || x >= nx || y >= ny) {
      if ((x < 0 && walk.step[0] < 0) || (y < 0 && walk.step[1] < 0) || (x >= nx && walk.step[0] > 0) ||
          (y >= ny && walk.step[1] > 0))
        break;
      entry = exit;
      continue;
    }
    const auto cell = static_cast<std::size_t>(y * nx + x);
    for (int k = first_[cell]; k < first_[cell + 1]; ++k) reach = visit(items_[static_cast<std::size_t>(k)]);
    entry = exit;
  }
}

}  // namespace plumbline::slam
