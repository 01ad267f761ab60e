// SPDX-License-Identifier: Apache-2.0
#include "sim/route/narrow.h"

#include <algorithm>

namespace plumbline::sim {

namespace {

/// Part of a segment from s0 to s1, m from its start.
struct Stretch {
  double s0 = 0.0;
  double s1 = 0.0;
  double clearance_m = 0.0;  ///< least
};

std::vector<Stretch> narrow_stretches(const ClearanceMap& space, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                      const NarrowConfig& config) {
  const double length = (b - a).norm();
  const int count = 1 + static_cast<int>(length / config.sample_m);
  std::vector<Stretch> stretches;
  for (int i = 0; i <= count; ++i) {
    const double s = length * i / count;
    const double clearance = space.clearance(a + (b - a) * (static_cast<double>(i) / count));
    if (clearance >= config.narrow_m) continue;
    const double s0 = std::max(0.0, s - config.before_m), s1 = std::min(length, s + config.before_m);
    if (stretches.empty() || s0 > stretches.back().s1 + config.apart_m) stretches.push_back({s0, s1, clearance});
    stretches.back().s1 = s1;
    stretches.back().clearance_m = std::min(stretches.back().clearance_m, clearance);
  }
  for (Stretch& stretch : stretches) {
    if (stretch.s0 < config.apart_m) stretch.s0 = 0.0;
    if (stretch.s1 > length - config.apart_m) stretch.s1 = length;
  }
  return stretches;
}

}  // namespace

std::vector<Waypoint> with_clearance(const ClearanceMap& space, const std::vector<Eigen::Vector2d>& path,
                                     double floor_z_W, const NarrowConfig& config) {
  std::vector<Waypoint> way;
  const auto add = [&](const Eigen::Vector2d& p) -> Waypoint& {
    return way.emplace_back(Waypoint{{p.x(), p.y(), floor_z_W}});
  };
  if (!path.empty()) add(path.front());
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Eigen::Vector2d &a = path[i - 1], &b = path[i];
    const double length = (b - a).norm();
    double done = 0.0;
    for (const Stretch& stretch : narrow_stretches(space, a, b, config)) {
      if (stretch.s0 > done) add(a + (b - a) * (stretch.s0 / length));
      add(stretch.s1 < length ? Eigen::Vector2d(a + (b - a) * (stretch.s1 / length)) : b).clearance_m =
          stretch.clearance_m;
      done = stretch.s1;
    }
    if (done < length) add(b);
  }
  return way;
}

}  // namespace plumbline::sim
