// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/trot/swing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bim/random/stream.h"

namespace plumbline::sim {
namespace {

constexpr double swing_s = 0.19;

Eigen::Vector3d random_point(const Stream& stream, int i, std::uint32_t lane) {
  const auto tick = static_cast<std::uint64_t>(i);
  return {stream.uniform(tick, lane, 0), stream.uniform(tick, lane, 1), 0.2 * stream.uniform(tick, lane, 2)};
}

double flat(double, double, double) { return 0.0; }

SwingPath flat_path(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return swing_path(SwingConfig{}, flat, 1.0, from, to, false);
}

TEST(Swing, StartsAtLiftOffEndsAtTheTargetAndClearsBoth) {
  const Stream stream(1, "sim.gait.command");
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d from = random_point(stream, i, 0);
    const Eigen::Vector3d to = random_point(stream, i, 1);
    const FootTarget start = swing_point(SwingConfig{}, flat_path(from, to), 0.0, swing_s);
    const FootTarget end = swing_point(SwingConfig{}, flat_path(from, to), 1.0, swing_s);
    EXPECT_LT((start.p_W - from).norm() + start.v_W.norm(), 1e-12);
    EXPECT_LT((end.p_W - to).norm() + end.v_W.norm(), 1e-9);
    double top = 0.0;
    for (int k = 0; k <= 100; ++k)
      top = std::max(top, swing_point(SwingConfig{}, flat_path(from, to), 0.01 * k, swing_s).p_W.z());
    EXPECT_NEAR(top, std::max(from.z(), to.z()) + SwingConfig{}.clearance_m, 1e-9);
  }
}

TEST(Swing, VelocityIsTheDerivativeOfThePosition) {
  const Stream stream(2, "sim.gait.command");
  constexpr double h = 1e-6;
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d from = random_point(stream, i, 0);
    const Eigen::Vector3d to = random_point(stream, i, 1);
    const double s = 0.01 + 0.98 * stream.uniform(static_cast<std::uint64_t>(i), 2);
    const Eigen::Vector3d before = swing_point(SwingConfig{}, flat_path(from, to), s - h, swing_s).p_W;
    const Eigen::Vector3d after = swing_point(SwingConfig{}, flat_path(from, to), s + h, swing_s).p_W;
    const Eigen::Vector3d numeric = (after - before) / (2.0 * h * swing_s);
    // Truncation h^2 times a third derivative of some 1e4, and at the apex h times a jump in the second derivative.
    EXPECT_LT((numeric - swing_point(SwingConfig{}, flat_path(from, to), s, swing_s).v_W).norm(), 1e-4);
  }
}

TEST(Swing, TorqueVanishesOnTarget) {
  BodyState state;
  state.X_WR = Pose::from_xyz_yaw({1.0, 2.0, 0.5}, 0.7);
  for (std::size_t leg = 0; leg < leg_count; ++leg) {
    state.q[leg] = {0.05, 0.8, -1.5};
    state.bias[leg] = {1.0, 2.0, 3.0};
  }
  const Posture posture = posture_of(state);
  for (std::size_t leg = 0; leg < leg_count; ++leg) {
    const Eigen::Vector3d torque =
        swing_torque(SwingConfig{}, state, posture, {posture.foot_W[leg], Eigen::Vector3d::Zero()}, leg);
    EXPECT_LT((torque - state.bias[leg]).norm(), 1e-9);
  }
}

TEST(Foothold, StandingItIsUnderTheLegAndWalkingAheadOfIt) {
  BodyState state;
  state.X_WR = Pose::from_xyz_yaw({0.0, 0.0, 0.5}, 0.0);
  Gait gait{GaitConfig{}};
  gait.update({.still = false}, 0.002);
  while (gait.scheduled_stance(0)) gait.update({.still = false}, 0.002);
  const Terrain step_up = [](double x, double, double) { return x > 1.0 ? 0.1 : 0.0; };
  Reference reference(CommandConfig{}, state.X_WR);
  const Eigen::Vector3d rest = foothold(FootholdConfig{}, gait, state, reference, step_up, 0);
  EXPECT_LT((rest.head<2>() - Eigen::Vector2d(0.298, 0.1658)).norm(), 1e-12);
  EXPECT_NEAR(rest.z(), 0.035 - 0.006, 1e-12);

  for (int i = 0; i < 1000; ++i) reference.update({0.8, 0.0, 0.0, 1.0}, state.X_WR, 0.002);
  state.v_W.x() = 0.8;
  const Eigen::Vector3d ahead = foothold(FootholdConfig{}, gait, state, reference, step_up, 0);
  const double remaining = (1.0 - gait.swing_progress(0)) * gait.swing_s();
  EXPECT_NEAR(ahead.x() - rest.x(), 0.8 * (remaining + 0.5 * gait.stance_s()), 1e-9);

  state.X_WR.t.x() = 2.0;
  EXPECT_NEAR(foothold(FootholdConfig{}, gait, state, reference, step_up, 0).z(), 0.1 + 0.029, 1e-12);
}

}  // namespace
}  // namespace plumbline::sim
