// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/types/kinematics.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include "bim/random/stream.h"
#include "sim/robot/model.h"

namespace plumbline::sim {
namespace {

constexpr int samples = 1000;

/// Angles inside the limits of the inverse, knee off its singularity.
LegAngles random_angles(const Stream& stream, int sample, std::size_t leg) {
  const auto tick = static_cast<std::uint64_t>(sample);
  const auto lane = static_cast<std::uint32_t>(leg);
  return {-0.7 + 1.4 * stream.uniform(tick, lane, 0), -0.6 + 2.0 * stream.uniform(tick, lane, 1),
          -2.6 + 2.2 * stream.uniform(tick, lane, 2)};
}

TEST(Kinematics, ForwardAgreesWithThePhysicsModel) {
  const ModelPtr model = load_model(model_xml({}));
  const DataPtr data = make_data(*model);
  const Stream stream(1, "sim.gait.command");
  const char* feet[] = {"FL_foot", "FR_foot", "HL_foot", "HR_foot"};
  for (int i = 0; i < 50; ++i) {
    for (std::size_t leg = 0; leg < leg_count; ++leg) {
      const LegAngles q = random_angles(stream, i, leg);
      std::copy_n(q.data(), 3, data->qpos + 7 + 3 * leg);
    }
    mj_kinematics(model.get(), data.get());
    for (std::size_t leg = 0; leg < leg_count; ++leg) {
      const int geom = mj_name2id(model.get(), mjOBJ_GEOM, feet[leg]);
      const Eigen::Vector3d base(data->xpos[3], data->xpos[4], data->xpos[5]);
      const Eigen::Map<const Eigen::Vector3d> foot(data->geom_xpos + 3 * geom);
      // Both chains are a few products of rotations: rounding only.
      EXPECT_LT((foot - base - foot_R(leg, random_angles(stream, i, leg))).norm(), 1e-12);
    }
  }
}

TEST(Kinematics, JacobianIsTheDerivative) {
  const Stream stream(2, "sim.gait.command");
  constexpr double step = 1e-6;
  for (int i = 0; i < samples; ++i) {
    const auto leg = static_cast<std::size_t>(i % 4);
    const LegAngles q = random_angles(stream, i, leg);
    Eigen::Matrix3d numeric;
    for (int j = 0; j < 3; ++j) {
      const LegAngles h = step * LegAngles::Unit(j);
      numeric.col(j) = (foot_R(leg, q + h) - foot_R(leg, q - h)) / (2.0 * step);
    }
    // Central differences: truncation h^2 / 6 and cancellation 1e-16 / h are both near 1e-10.
    EXPECT_LT((numeric - foot_jacobian_R(leg, q)).norm(), 1e-8);
  }
}

TEST(Kinematics, InverseUndoesForward) {
  const Stream stream(3, "sim.gait.command");
  for (int i = 0; i < samples; ++i) {
    const auto leg = static_cast<std::size_t>(i % 4);
    const LegAngles q = random_angles(stream, i, leg);
    const Eigen::Vector3d p_R = foot_R(leg, q);
    if (p_R.z() > -0.15) continue;  // above that the foot's mirror solution beside the hip is the nearer one
    // acos near a stretched leg amplifies rounding by 1 / sin(knee) <= 3.
    EXPECT_LT((leg_angles(leg, p_R) - q).norm(), 1e-9) << "sample " << i;
  }
}

TEST(Kinematics, InverseStaysInsideTheJointRanges) {
  const Stream stream(4, "sim.gait.command");
  for (int i = 0; i < samples; ++i) {
    const auto tick = static_cast<std::uint64_t>(i);
    const Eigen::Vector3d p_R(-2.0 + 4.0 * stream.uniform(tick, 0), -2.0 + 4.0 * stream.uniform(tick, 1),
                              -2.0 + 4.0 * stream.uniform(tick, 2));
    const LegAngles q = leg_angles(static_cast<std::size_t>(i % 4), p_R);
    EXPECT_LE(std::abs(q[0]), 0.785);
    EXPECT_GE(q[1], -0.9);
    EXPECT_LE(q[1], 2.29);
    EXPECT_GE(q[2], -2.79);
    EXPECT_LE(q[2], -0.25);
  }
}

}  // namespace
}  // namespace plumbline::sim
