// SPDX-License-Identifier: Apache-2.0
#include "slam/process/trial_walk.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bim/random/stream.h"
#include "slam/io/second.h"

namespace plumbline::slam {

namespace {

constexpr int rings = 16, columns = 360, scans = 50;
constexpr Nanoseconds period_ns = 100'000'000, odometry_ns = 20'000'000, imu_ns = 10'000'000;
constexpr double start_s = 1.0, speed_mps = 1.0, turn_radps = 0.3;
constexpr double body_m = 0.5, farthest_m = 100.0, noise_m = 0.01, odometry_scale = 1.01;

/// An axis-parallel box.
struct Box {
  Eigen::Vector3d least, most;
};
const Box room{{0, 0, 0}, {10, 8, 3}};
const std::vector<Box> columns_of_room = {{{6.0, 5.5, 0}, {6.5, 6.0, 3}}, {{2.0, 1.2, 0}, {2.4, 1.6, 3}}};

/// Where a ray enters and leaves a box; enters after it leaves where it misses.
std::pair<double, double> crossing(const Box& box, const Eigen::Vector3d& from, const Eigen::Vector3d& along) {
  double enters = -std::numeric_limits<double>::infinity(), leaves = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 3; ++a) {
    const double u = (box.least[a] - from[a]) / along[a], v = (box.most[a] - from[a]) / along[a];
    enters = std::max(enters, std::min(u, v));
    leaves = std::min(leaves, std::max(u, v));
  }
  return {enters, leaves};
}

double range_to_surface(const Eigen::Vector3d& from, const Eigen::Vector3d& along) {
  double nearest = crossing(room, from, along).second;
  for (const Box& column : columns_of_room) {
    const auto [enters, leaves] = crossing(column, from, along);
    if (enters > 0.0 && enters < leaves) nearest = std::min(nearest, enters);
  }
  return nearest;
}

Scan scan_at(Nanoseconds stamp, const Pose& X_RL, int index) {
  static const Stream noise(1, "slam.trial");
  Scan scan;
  scan.stamp = stamp;
  scan.rings = rings;
  scan.columns = columns;
  for (int column = 0; column < columns; ++column) {
    const auto offset = static_cast<std::int32_t>(-period_ns * (columns - 1 - column) / columns);
    const Pose X_WL = trial_pose(stamp + offset) * X_RL;
    const double azimuth = -2.0 * std::numbers::pi * column / columns;
    for (int ring = 0; ring < rings; ++ring) {
      const double elevation = (2.0 * ring - 15.0) * std::numbers::pi / 180.0;
      const Eigen::Vector3d along_L(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                    std::sin(elevation));
      double range = range_to_surface(X_WL.t, X_WL.q * along_L);
      range += noise_m * noise.gauss(static_cast<std::uint64_t>(index), static_cast<std::uint32_t>(column),
                                     static_cast<std::uint32_t>(ring));
      const bool hit = range < farthest_m;
      scan.range_m.push_back(hit ? range : 0.0);
      scan.point_L.emplace_back(hit ? Eigen::Vector3d(range * along_L) : Eigen::Vector3d::Zero());
      scan.reflectivity.push_back(hit ? 40.0F : 0.0F);
      scan.offset_ns.push_back(offset);
    }
  }
  return scan;
}

Imu imu_at(Nanoseconds t) {
  const bool walks = seconds(t) > start_s;
  return {t, {0, 0, walks ? turn_radps : 0.0}, {0, walks ? speed_mps * turn_radps : 0.0, 9.81}};
}

}  // namespace

Pose trial_pose(Nanoseconds t) {
  const Pose X_WS = Pose::from_xyz_yaw({3.0, 3.0, body_m}, 0.2);
  const double walked_s = std::max(0.0, seconds(t) - start_s), yaw = turn_radps * walked_s;
  const double radius = speed_mps / turn_radps;
  return X_WS * Pose::from_xyz_yaw({radius * std::sin(yaw), radius * (1.0 - std::cos(yaw)), 0.0}, yaw);
}

TrialWalk trial_walk() {
  TrialWalk walk;
  walk.calibration.X_RL = Pose::from_xyz_yaw({0.2, 0.0, 0.16}, std::numbers::pi / 2.0);
  walk.calibration.sensor_height_m = body_m + walk.calibration.X_RL.t.z();
  const Pose X_SW = trial_pose(0).inverse();
  for (int i = 0; i < scans; ++i) {
    const Nanoseconds from = i * period_ns, to = from + period_ns;
    TrialStep step;
    for (Nanoseconds t = from + imu_ns; t <= to; t += imu_ns) step.imu.push_back(imu_at(t));
    for (Nanoseconds t = from + odometry_ns; t <= to; t += odometry_ns) {
      Pose X_OR = X_SW * trial_pose(t);
      X_OR.t *= odometry_scale;
      step.odometry.push_back({t, X_OR});
    }
    step.scan = scan_at(to, walk.calibration.X_RL, i);
    step.X_WR = trial_pose(to);
    walk.steps.push_back(std::move(step));
  }
  return walk;
}

std::string trial_plan() {
  return "plan: 1\n"
         "name: trial\n"
         "storeys: [{id: ground, elevation_m: 0, height_m: 3}]\n"
         "walls:\n"
         "  - {id: south, storey: ground, a: [0, 0], b: [10, 0], thickness_m: 0.2, just: left}\n"
         "  - {id: east, storey: ground, a: [10, 0], b: [10, 8], thickness_m: 0.2, just: left}\n"
         "  - {id: north, storey: ground, a: [10, 8], b: [0, 8], thickness_m: 0.2, just: left}\n"
         "  - {id: west, storey: ground, a: [0, 8], b: [0, 0], thickness_m: 0.2, just: left}\n"
         "columns:\n"
         "  - {id: c1, storey: ground, at: [6.25, 5.75], size: [0.5, 0.5], height_m: 3}\n"
         "  - {id: c2, storey: ground, at: [2.2, 1.4], size: [0.4, 0.4], height_m: 3}\n"
         "rooms: [{id: hall, storey: ground, polygon: [[0, 0], [10, 0], [10, 8], [0, 8]]}]\n";
}

}  // namespace plumbline::slam
