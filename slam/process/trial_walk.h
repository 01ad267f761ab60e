// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "slam/io/records.h"

namespace plumbline::slam {

/// A scan with what was measured since the one before, and where the robot was at its end.
struct TrialStep {
  std::vector<Imu> imu;
  std::vector<Odometry> odometry;
  Scan scan;
  Pose X_WR;
};

/// A walk of a few seconds that a method which is a process can be tried on: an empty room of 10 x 8 m with two
/// columns, 16 rings of a LiDAR that is mounted turned by a quarter, 1 cm of noise; the robot stands for a second, then
/// walks a bend at 1 m/s. Odometry is too long by 1 %. The same every time.
struct TrialWalk {
  Calibration calibration;
  std::vector<TrialStep> steps;
};

[[nodiscard]] TrialWalk trial_walk();
/// The room as a plan file (YAML), for localizations.
[[nodiscard]] std::string trial_plan();
/// True pose in W at any time of the walk.
[[nodiscard]] Pose trial_pose(Nanoseconds t);

}  // namespace plumbline::slam
