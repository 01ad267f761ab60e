// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenarios/metrics/trajectory.h"

namespace plumbline::scenarios::score {

inline constexpr slam::Nanoseconds scan_ns = 100'000'000;

/// Along x, a pose a scan.
[[nodiscard]] inline Truth straight_walk(int scans, const Eigen::Vector3d& from, double step_m) {
  Truth truth;
  for (int i = 0; i < scans; ++i) {
    truth.scans.push_back(i * scan_ns);
    truth.poses_W.push_back({i * scan_ns, Pose::from_xyz_yaw(from + step_m * i * Eigen::Vector3d::UnitX(), 0.0)});
  }
  return truth;
}

}  // namespace plumbline::scenarios::score
