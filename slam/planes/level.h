// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <span>

#include "slam/scan/plane_observation.h"

namespace plumbline::slam {

[[nodiscard]] bool is_floor(const PlaneObservation& seen);

/// Attitude of R in a frame whose z axis stands on the first floor seen, so that walls are upright in it whatever the
/// gait's phase or the sensor's mount; identity without a floor.
[[nodiscard]] Eigen::Quaterniond level_by_floor(std::span<const PlaneObservation> seen);

}  // namespace plumbline::slam
