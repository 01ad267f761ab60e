// SPDX-License-Identifier: Apache-2.0
#include "slam/localize/segment_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace plumbline::slam {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// Rays starting on a face (a robot never does, a reflection of rounding may) do not hit that face.
constexpr double min_distance_m = 1e-9;

bool in_hole(const PlanSegment& segment, double s, double z) {
  return std::any_of(segment.holes.begin(), segment.holes.end(), [&](const bim::FaceHole& hole) {
    return s > hole.s0 && s < hole.s1 && z > hole.z0 && z < hole.z1;
  });
}

/// Where a ray meets the rectangle of a face.
struct Meeting {
  double distance = infinity;  ///< infinity: not at all
  bool hole = false;
};

Meeting meet(const PlanSegment& segment, const PlanRay& ray) {
  const double along = ray.direction.dot(segment.n);
  if (std::abs(along) < 1e-12) return {};
  const Eigen::Vector2d to_a = segment.a - ray.origin;
  const double t = to_a.dot(segment.n) / along;
  if (t <= min_distance_m) return {};
  const double s = (t * ray.direction - to_a).dot(segment.e);
  if (s < 0.0 || s > segment.length) return {};
  const double z = ray.z + t * ray.slope;
  if (z < segment.z0 || z > segment.z1) return {};
  return {t, in_hole(segment, s, z)};
}

/// Distance at which the ray hits the face, or infinity.
double hit_distance(const PlanSegment& segment, const PlanRay& ray) {
  const Meeting meeting = meet(segment, ray);
  return meeting.hole ? infinity : meeting.distance;
}

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

SegmentGrid::SegmentGrid(const std::vector<PlanSegment>& segments, double cell_m) : cell_(cell_m) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(infinity);
  Eigen::Vector2d high = -low;
  for (const PlanSegment& segment : segments) {
    const Eigen::Vector2d b = segment.a + segment.length * segment.e;
    low = low.cwiseMin(segment.a).cwiseMin(b);
    high = high.cwiseMax(segment.a).cwiseMax(b);
  }
  if (segments.empty()) low = high = Eigen::Vector2d::Zero();
  origin_ = low.array() - cell_;
  nx_ = static_cast<int>(std::ceil((high.x() - low.x()) / cell_)) + 2;
  ny_ = static_cast<int>(std::ceil((high.y() - low.y()) / cell_)) + 2;
  fill(segments);
}

void SegmentGrid::fill(const std::vector<PlanSegment>& segments) {
  std::vector<std::vector<int>> lists(static_cast<std::size_t>(cells()));
  // A face is listed in every cell it comes within a hair of, so that rounding at cell borders loses nothing.
  const double reach = 0.5 * cell_ + 1e-6;
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

PlanHit SegmentGrid::cast(const std::vector<PlanSegment>& segments, const PlanRay& ray, double max_distance) const {
  PlanHit best{max_distance, -1};
  march(
      ray,
      [&](int i) {
        const double t = hit_distance(segments[static_cast<std::size_t>(i)], ray);
        if (t < best.distance || (t == best.distance && best.segment >= 0 && i < best.segment)) best = {t, i};
        return best.distance;
      },
      max_distance);
  return best;
}

bool SegmentGrid::crosses_opening(const std::vector<PlanSegment>& segments, const PlanRay& ray, double from,
                                  double to) const {
  const PlanRay rest{ray.origin + from * ray.direction, ray.direction, ray.z + from * ray.slope, ray.slope};
  bool found = false;
  march(
      rest,
      [&](int i) {
        const Meeting meeting = meet(segments[static_cast<std::size_t>(i)], rest);
        found = found || (meeting.hole && meeting.distance <= to - from);
        return found ? 0.0 : to - from;
      },
      to - from);
  return found;
}

template <class Visit>
void SegmentGrid::march(const PlanRay& ray, Visit visit, double reach) const {
  GridWalk walk(ray.origin - origin_, ray.direction, cell_);
  for (double entry = 0.0; entry < reach; walk.advance()) {
    const double exit = walk.exit();
    const auto [x, y] = walk.cell;
    if (x < 0 || y < 0 || x >= nx_ || y >= ny_) {
      if ((x < 0 && walk.step[0] < 0) || (y < 0 && walk.step[1] < 0) || (x >= nx_ && walk.step[0] > 0) ||
          (y >= ny_ && walk.step[1] > 0))
        break;
      entry = exit;
      continue;
    }
    const auto cell = static_cast<std::size_t>(y * nx_ + x);
    for (int k = first_[cell]; k < first_[cell + 1]; ++k) reach = visit(items_[static_cast<std::size_t>(k)]);
    entry = exit;
  }
}

int SegmentGrid::cell_at(const Eigen::Vector2d& p) const {
  const int x = static_cast<int>(std::floor((p.x() - origin_.x()) / cell_));
  const int y = static_cast<int>(std::floor((p.y() - origin_.y()) / cell_));
  return x < 0 || y < 0 || x >= nx_ || y >= ny_ ? -1 : y * nx_ + x;
}

Eigen::Vector2d SegmentGrid::cell_center(int cell) const {
  return origin_ + cell_ * Eigen::Vector2d(cell % nx_ + 0.5, cell / nx_ + 0.5);
}

}  // namespace plumbline::slam
