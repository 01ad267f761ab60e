// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/trot/wrench.h"

#include <gtest/gtest.h>

#include <cmath>

namespace plumbline::sim {
namespace {

/// Feet on the plane z = a x + b y + c.
PerLeg<LegContact> feet_on(double a, double b, double c) {
  PerLeg<Eigen::Vector3d> foot_W;
  for (std::size_t leg = 0; leg < leg_count; ++leg) {
    foot_W[leg] = hip_R(leg);
    foot_W[leg].z() = a * foot_W[leg].x() + b * foot_W[leg].y() + c;
  }
  return initial_contacts(foot_W);
}

TEST(SupportPlane, FindsTheSlopeItsFeetStandOn) {
  SupportPlane plane{PostureConfig{}};
  const PerLeg<LegContact> legs = feet_on(0.2, -0.1, 0.135);
  for (int i = 0; i < 1000; ++i) plane.update(legs, 0.002);
  const Eigen::Vector3d expected = Eigen::Vector3d(-0.2, 0.1, 1.0).normalized();
  // The fit is damped by 1e-4 against a spread of 4 * 0.055^2 across: the slope comes out 1 % low.
  EXPECT_LT((plane.normal_W() - expected).norm(), 0.003);
  EXPECT_NEAR(plane.ground_height({0.1, 0.0, 7.0}), 0.02 + 0.135 - 0.035, 0.001);
}

TEST(DesiredWrench, AtRestItIsTheWeight) {
  BodyState state;
  state.X_WR = Pose::from_xyz_yaw({0.0, 0.0, 0.5}, 0.3);
  SupportPlane plane{PostureConfig{}};
  plane.update(feet_on(0.0, 0.0, 0.035), 0.002);
  const Reference reference(CommandConfig{}, state.X_WR);
  Wrench weight = Wrench::Zero();
  weight[2] = 30.0 * gravity;
  EXPECT_LT((desired_wrench(PostureConfig{}, state, reference, plane, 30.0) - weight).norm(), 1e-9);
}

TEST(DesiredWrench, PushesBackAgainstEveryError) {
  SupportPlane plane{PostureConfig{}};
  plane.update(feet_on(0.0, 0.0, 0.035), 0.002);
  const Pose X_WR = Pose::from_xyz_yaw({0.0, 0.0, 0.5}, 0.0);
  const Reference reference(CommandConfig{}, X_WR);
  const auto wrench = [&](const BodyState& state) {
    return desired_wrench(PostureConfig{}, state, reference, plane, 30.0);
  };
  for (int axis = 0; axis < 3; ++axis) {
    BodyState moved;
    moved.X_WR = X_WR;
    moved.X_WR.t[axis] += 0.02;
    EXPECT_LT(wrench(moved)[axis], axis == 2 ? 30.0 * gravity : 0.0) << axis;
    BodyState turned;
    turned.X_WR = X_WR;
    turned.X_WR.q = exp_so3(0.05 * Eigen::Vector3d::Unit(axis));
    EXPECT_LT(wrench(turned)[3 + axis], 0.0) << axis;
    BodyState spinning;
    spinning.X_WR = X_WR;
    spinning.omega_W[axis] = 0.2;
    EXPECT_LT(wrench(spinning)[3 + axis], 0.0) << axis;
  }
}

TEST(Reference, SlewsVelocitiesAndKeepsToItsLeashes) {
  const Pose X_WR;
  Reference reference(CommandConfig{}, X_WR);
  for (int i = 0; i < 250; ++i) reference.update({2.0, 0.0, 3.0, 1.0}, X_WR, 0.002);
  EXPECT_NEAR(reference.speed(), 0.6, 1e-9);      // 1.2 m/s^2 for 0.5 s
  EXPECT_NEAR(reference.yaw_rate(), 1.25, 1e-9);  // 2.5 rad/s^2 for 0.5 s
  for (int i = 0; i < 2500; ++i) reference.update({2.0, 0.0, 3.0, 1.0}, X_WR, 0.002);
  EXPECT_NEAR(reference.position_W().norm(), 0.08, 1e-9);
  EXPECT_NEAR(reference.yaw(), 0.25, 1e-9);
}

}  // namespace
}  // namespace plumbline::sim
