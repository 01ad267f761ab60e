// SPDX-License-Identifier: Apache-2.0
#include "sim/route/speed_profile.h"

#include <algorithm>
#include <cmath>

#include "bim/geometry/pose.h"

namespace plumbline::sim {

namespace {

double segment_speed(const SpeedConfig& config, const Waypoint& end) {
  const double free = end.clearance_m - config.half_width_m;
  const double speed = std::min(config.speed_mps, std::max(config.narrow_min_mps, free / config.narrow_s));
  return end.stairs ? std::min(speed, config.stairs_mps) : speed;
}

/// On the arc that touches both segments of the bend corner_m away from it.
double corner_speed(const SpeedConfig& config, const Eigen::Vector2d& before, const Eigen::Vector2d& after) {
  if (before.norm() <= 0.0 || after.norm() <= 0.0) return config.speed_mps;
  const double bend = std::abs(wrap_angle(std::atan2(after.y(), after.x()) - std::atan2(before.y(), before.x())));
  const double half_tangent = std::tan(0.5 * std::min(bend, 3.0));
  if (half_tangent * config.speed_mps <= config.corner_rate * config.corner_m) return config.speed_mps;
  return std::max(config.corner_min_mps, config.corner_rate * config.corner_m / half_tangent);
}

}  // namespace

SpeedProfile::SpeedProfile(const SpeedConfig& config, const std::vector<Waypoint>& way) : braking_(config.braking) {
  const auto segment = [&](std::size_t i) -> Eigen::Vector2d { return (way[i].p_W - way[i - 1].p_W).head<2>(); };
  for (const Waypoint& end : way) segment_limits_.push_back(segment_speed(config, end));
  waypoint_limits_.assign(way.size(), config.speed_mps);
  for (std::size_t i = way.size() - std::min<std::size_t>(way.size(), 2); i > 0; --i) {
    const double next =
        std::sqrt(waypoint_limits_[i + 1] * waypoint_limits_[i + 1] + 2.0 * braking_ * segment(i + 1).norm());
    waypoint_limits_[i] = std::min({segment_limits_[i + 1], next, corner_speed(config, segment(i), segment(i + 1))});
  }
}

double SpeedProfile::limit(std::size_t next, double left_m) const {
  return std::min(segment_limits_[next],
                  std::sqrt(waypoint_limits_[next] * waypoint_limits_[next] + 2.0 * braking_ * std::max(0.0, left_m)));
}

}  // namespace plumbline::sim
