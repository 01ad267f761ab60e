// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "bim/geometry/pose.h"
#include "sim/robot/types/kinematics.h"

namespace plumbline::sim {

template <class T>
using PerLeg = std::array<T, leg_count>;

/// Zero vectors: an Eigen vector is not zero by itself, not even in an array{}.
[[nodiscard]] PerLeg<Eigen::Vector3d> zero_per_leg();

/// True state of the robot that the controller sees before a physics step. touch, bias and com_W belong to the start
/// of the step before, since MuJoCo computes them inside a step.
struct BodyState {
  Pose X_WR;
  Eigen::Vector3d v_W = Eigen::Vector3d::Zero();      ///< m/s
  Eigen::Vector3d omega_W = Eigen::Vector3d::Zero();  ///< rad/s
  PerLeg<LegAngles> q = zero_per_leg();               ///< rad
  PerLeg<Eigen::Vector3d> qd = zero_per_leg();        ///< rad/s
  PerLeg<Eigen::Vector3d> bias = zero_per_leg();      ///< gravity and Coriolis torques, N m
  PerLeg<double> touch{};                             ///< N
  Eigen::Vector3d com_W = Eigen::Vector3d::Zero();    ///< of the whole robot
};

/// What follows from a BodyState by kinematics alone.
struct Posture {
  double yaw = 0.0;                                 ///< rad
  PerLeg<Eigen::Vector3d> foot_W = zero_per_leg();  ///< centres of the feet
  PerLeg<Eigen::Matrix3d> jacobian_R{};
};

[[nodiscard]] Posture posture_of(const BodyState& state);

}  // namespace plumbline::sim
