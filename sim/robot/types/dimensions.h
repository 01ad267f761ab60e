// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace plumbline::sim {

/// Legs in the order of every per-leg array: FL, FR, HL, HR.
inline constexpr std::size_t leg_count = 4;

/// +1 for a left leg, -1 for a right one.
[[nodiscard]] constexpr double side_sign(std::size_t leg) { return leg % 2 == 0 ? 1.0 : -1.0; }
/// +1 for a front leg, -1 for a hind one.
[[nodiscard]] constexpr double front_sign(std::size_t leg) { return leg < 2 ? 1.0 : -1.0; }

/// Lengths that the physics model, the leg kinematics and the controller share, m; after the Spot of [zakka2022].
struct RobotDimensions {
  double hip_x = 0.298;       ///< base origin to hip, forward
  double hip_y = 0.055;       ///< base origin to hip, sideways
  double abduction = 0.1108;  ///< hip to the leg plane
  double thigh = 0.32;        ///< hip joint to knee
  double shank = 0.34;        ///< knee to the centre of the foot sphere
  double foot_radius = 0.035;
  double lidar_height = 0.16;  ///< base origin to the LiDAR's origin
};

/// The one robot there is.
inline constexpr RobotDimensions robot_dimensions{};

}  // namespace plumbline::sim
