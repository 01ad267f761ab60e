// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/robot/trot/contact.h"
#include "sim/robot/trot/reference.h"
#include "sim/robot/trot/trot_config.h"

namespace plumbline::sim {

/// The plane the feet stand on, low-passed; docs/methods/robot.md.
class SupportPlane {
 public:
  explicit SupportPlane(const PostureConfig& config) : config_(config) {}
  void update(const PerLeg<LegContact>& legs, double dt);

  [[nodiscard]] const Eigen::Vector3d& normal_W() const { return normal_W_; }
  /// Height of the ground (not of the foot centres) under a point, m.
  [[nodiscard]] double ground_height(const Eigen::Vector3d& p_W) const;

 private:
  PostureConfig config_;
  Eigen::Vector3d normal_W_ = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d mean_W_ = Eigen::Vector3d::Zero();
};

/// Mean of the last stance points.
[[nodiscard]] Eigen::Vector3d stance_center(const PerLeg<LegContact>& legs);

/// Force (N) and torque (N m) the ground should exert on the robot, about its centre of mass, in W.
using Wrench = Vector6d;

/// Posture control, docs/methods/robot.md; mass in kg.
[[nodiscard]] Wrench desired_wrench(const PostureConfig& config, const BodyState& state, const Reference& reference,
                                    const SupportPlane& plane, double mass);

}  // namespace plumbline::sim
