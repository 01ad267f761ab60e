// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "slam/io/recordings/recording.h"

namespace plumbline::slam {

/// Files that hold what a robot measured of its own motion, on the clock of the recording that holds the scans.
struct MotionFiles {
  std::string odometry;  ///< poses X_OR in the form of TUM or EuRoC, or of KITTI, one for each scan; empty: none
  std::string imu;       ///< imu.csv of a recording, or EuRoC's data.csv (ns, rad/s, m/s^2), in R; empty: none
};

/// The recording with these beside its scans. Scans before the first odometry are left out and counted. Throws
/// InputError naming file and line, here or from next(), also where the recording has odometry or an IMU of its own,
/// where no scan overlaps the odometry, and where poses without times are not as many as the scans.
[[nodiscard]] std::unique_ptr<Recording> with_motion(std::unique_ptr<Recording> recording, const MotionFiles& files);

}  // namespace plumbline::slam
