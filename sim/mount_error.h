// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "slam/io/records.h"

namespace plumbline::sim {

/// How far the told mount of the LiDAR is from the true one; docs/methods/robot.md.
struct MountError {
  double length_m = 0.0;                      ///< of the error of position; its direction is drawn
  double angle_rad = 0.0;                     ///< of the error of attitude; its axis is drawn
  std::optional<Eigen::Vector3d> offset_R;    ///< given instead of the first draw, m
  std::optional<Eigen::Vector3d> rotation_L;  ///< given instead of the second, rad
};

/// What estimators are told of the mount. Without an error, the truth.
[[nodiscard]] slam::Calibration told_calibration(const slam::Calibration& truth, const MountError& error,
                                                 std::uint64_t seed);

}  // namespace plumbline::sim
