// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/robot/trot/contact.h"
#include "sim/robot/trot/force_distribution.h"
#include "sim/robot/trot/reference.h"
#include "sim/robot/trot/swing.h"
#include "sim/robot/trot/trot_config.h"
#include "sim/robot/trot/wrench.h"
#include "sim/robot/types/command.h"
#include "sim/robot/types/terrain.h"

namespace plumbline::sim {

/// Joint torques, N m, in the order of the actuators.
using Torques = std::array<double, 12>;

/// Trot controller, docs/methods/robot.md. It sees the true state: it stands for the robot maker's own controller
/// and belongs to the world, not to an estimator.
class Trot {
 public:
  /// state: the robot on its four feet; mass in kg; step in s.
  Trot(const TrotConfig& config, const BodyState& state, double mass, double step_s);

  /// Torques for the next physics step.
  [[nodiscard]] Torques update(const BodyState& state, const Command& command, const Terrain& terrain);

 private:
  void change_height();
  [[nodiscard]] GaitDemand gait_demand(const BodyState& state, const Command& command) const;
  void plan_footholds(const BodyState& state, const Posture& posture, const Terrain& terrain);
  [[nodiscard]] double force_limit(std::size_t leg) const;
  [[nodiscard]] FootTarget foot_target(const Posture& posture, std::size_t leg) const;

  TrotConfig config_;
  double mass_;
  double step_s_;
  Reference reference_;
  Gait gait_;
  PerLeg<LegContact> legs_;
  PerLeg<SwingPath> swing_;
  SupportPlane plane_;
  PostureConfig posture_;  ///< with the height of the moment
  ForceDistribution distribution_;
  std::int64_t steps_ = 0;
};

}  // namespace plumbline::sim
