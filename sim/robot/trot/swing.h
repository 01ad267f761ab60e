// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/robot/trot/gait.h"
#include "sim/robot/trot/reference.h"
#include "sim/robot/trot/trot_config.h"
#include "sim/robot/types/terrain.h"

namespace plumbline::sim {

/// Desired motion of a foot's centre.
struct FootTarget {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_W = Eigen::Vector3d::Zero();  ///< m/s
};

/// True when the sole of a foot is at the level of the ground under or right beside it.
[[nodiscard]] bool at_ground_level(const ContactConfig& config, const Terrain& terrain, double z_max,
                                   const Eigen::Vector3d& foot_W);

/// How a foot swings to its target.
struct SwingPath {
  Eigen::Vector3d from_W = Eigen::Vector3d::Zero();  ///< foot centre at lift-off
  Eigen::Vector3d to_W = Eigen::Vector3d::Zero();
  double apex_z_W = 0.0;     ///< m
  bool steps = false;        ///< over steps: up first, then across, then down
  double across_from = 0.0;  ///< part of the swing at which the foot starts across,
  double across_to = 1.0;    ///< and at which it ends
};

/// Where a swinging foot should land, as foot centre, after [dicarlo2018]; near edges, the nearest place with
/// even ground around it (ties: the one farthest back, then to the right).
[[nodiscard]] Eigen::Vector3d foothold(const FootholdConfig& config, const Gait& gait, const BodyState& state,
                                       const Reference& reference, const Terrain& terrain, std::size_t leg);

/// True when the ground between two foot centres, up to z_max, is not even.
[[nodiscard]] bool over_steps(const SwingConfig& config, const Terrain& terrain, double z_max,
                              const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W);

/// Path between two foot centres that clears the ground between them up to z_max.
[[nodiscard]] SwingPath swing_path(const SwingConfig& config, const Terrain& terrain, double z_max,
                                   const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W, bool steps);

/// Lets a foot at foot_W, which is still too low for the ground ahead of it, wait: it starts across later.
void wait_for_height(const SwingConfig& config, const Terrain& terrain, double z_max, const Eigen::Vector3d& foot_W,
                     double progress_step, SwingPath& path);

/// Point on the path at progress in [0, 1), docs/methods/robot.md.
[[nodiscard]] FootTarget swing_point(const SwingConfig& config, const SwingPath& path, double progress, double swing_s);

/// Torques that follow a foot target, N m.
[[nodiscard]] Eigen::Vector3d swing_torque(const SwingConfig& config, const BodyState& state, const Posture& posture,
                                           const FootTarget& target, std::size_t leg);

}  // namespace plumbline::sim
