// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/upright.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace plumbline::slam {

double snap(double value) { return std::round(value * 1e6) * 1e-6; }

Eigen::Vector2d snap(const Eigen::Vector2d& p) { return {snap(p.x()), snap(p.y())}; }

PlanSegment upright(const Eigen::Vector2d& p0, const Eigen::Vector2d& p1, double z0, double z1, const Pose2& X_IW,
                    double base_z) {
  PlanSegment segment;
  segment.a = snap(X_IW * p0);
  const Eigen::Vector2d b = snap(X_IW * p1);
  segment.length = (b - segment.a).norm();
  segment.e = (b - segment.a) / segment.length;
  segment.n = {-segment.e.y(), segment.e.x()};
  segment.z0 = snap(z0 - base_z);
  segment.z1 = snap(z1 - base_z);
  return segment;
}

std::vector<PlanSegment> sides_of(const bim::PlanSolid& solid, const Pose2& X_IW, double base_z) {
  std::vector<PlanSegment> sides;
  for (std::size_t i = 0; i < solid.outline.size(); ++i) {
    // Free space is on the right of a counter-clockwise outline.
    const Eigen::Vector2d &p1 = solid.outline[i], &p0 = solid.outline[(i + 1) % solid.outline.size()];
    if ((p1 - p0).norm() >= 1e-3) sides.push_back(upright(p0, p1, solid.z0, solid.z1, X_IW, base_z));
  }
  return sides;
}

void sort_by_geometry(std::vector<PlanSegment>& segments) {
  const auto key = [](const PlanSegment& s) {
    return std::make_tuple(s.a.x(), s.a.y(), s.e.x(), s.e.y(), s.length, s.z0, s.z1, s.plan_face < 0);
  };
  std::stable_sort(segments.begin(), segments.end(),
                   [&](const PlanSegment& a, const PlanSegment& b) { return key(a) < key(b); });
}

}  // namespace plumbline::slam
