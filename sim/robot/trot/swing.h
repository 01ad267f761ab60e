// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/robot/robot.h"
#include "sim/robot/trot/config.h"
#include "sim/robot/trot/gait.h"
#include "sim/robot/trot/reference.h"

namespace plumbline::sim {

/// Desired motion of a foot's centre.
struct FootTarget {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_W = Eigen::Vector3d::Zero();  ///< m/s
};

/// Where a swinging foot should land, as foot centre [facts: legged section 4.5].
[[nodiscard]] Eigen::Vector3d foothold(const FootholdConfig& config, const Gait& gait, const BodyState& state,
                                       const Reference& reference, const Terrain& terrain, std::size_t leg);

/// Point on the swing from lift_off_W to target_W at progress in [0, 1) [facts: legged section 4.6].
[[nodiscard]] FootTarget swing_point(const SwingConfig& config, const Eigen::Vector3d& lift_off_W,
                                     const Eigen::Vector3d& target_W, double progress, double swing_s);

/// Torques that follow a foot target [facts: legged section 4.7], N m.
[[nodiscard]] Eigen::Vector3d swing_torque(const SwingConfig& config, const BodyState& state, const Posture& posture,
                                           const FootTarget& target, std::size_t leg);

}  // namespace plumbline::sim
