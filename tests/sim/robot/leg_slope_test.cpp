// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/leg_slope.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bim/geometry/pose.h"
#include "bim/random/stream.h"
#include "sim/robot/types/dimensions.h"
#include "tests/sim/robot/physics_step.h"

namespace plumbline::sim {
namespace {

constexpr std::array<bool, 4> all_stand = {true, true, true, true};

/// Feet of a robot at p_O on the plane through the origin with this normal.
std::array<Eigen::Vector3d, 4> feet_on(const Eigen::Vector3d& normal_O, const Eigen::Vector2d& p_O) {
  std::array<Eigen::Vector3d, 4> feet;
  for (std::size_t leg = 0; leg < leg_count; ++leg) {
    const Eigen::Vector2d at = p_O + Eigen::Vector2d(0.3 * front_sign(leg), 0.17 * side_sign(leg));
    feet[leg] = {at.x(), at.y(), -normal_O.head<2>().dot(at) / normal_O.z()};
  }
  return feet;
}

TEST(LegSlope, FindsTheNormalOfAnyRamp) {
  const Stream stream(1, "bim.generate");
  for (std::uint64_t i = 0; i < 200; ++i) {
    const double heading = 2.0 * std::numbers::pi * stream.uniform(i, 0), tilt = 0.24 * stream.uniform(i, 1);
    const Eigen::Vector3d normal_O =
        exp_so3(tilt * Eigen::Vector3d(std::cos(heading), std::sin(heading), 0.0)) * Eigen::Vector3d::UnitZ();
    LegSlope slope{LegSlopeConfig{}};
    for (int step = 0; step < 2000; ++step) slope.update(feet_on(normal_O, {0.001 * step, 0.0}), all_stand, step_s);
    // The damping of the fit takes 0.1 % of the slope.
    EXPECT_LT((slope.normal_O() - normal_O).norm(), 0.002 * tilt + 1e-6) << tilt;
  }
}

TEST(LegSlope, IsLevelUntilAllFeetHaveStoodAndOnStairs) {
  const auto after = [](double tilt, const std::array<bool, 4>& stands) {
    LegSlope slope{LegSlopeConfig{}};
    const Eigen::Vector3d normal_O(-std::sin(tilt), 0.0, std::cos(tilt));
    for (int step = 0; step < 2000; ++step) slope.update(feet_on(normal_O, {0.0, 0.0}), stands, step_s);
    return slope.normal_O();
  };
  EXPECT_EQ(after(0.1, {true, true, true, false}), Eigen::Vector3d::UnitZ());
  EXPECT_NE(after(0.1, all_stand), Eigen::Vector3d::UnitZ());
  EXPECT_EQ(after(std::atan(0.15 / 0.30), all_stand), Eigen::Vector3d::UnitZ());
}

}  // namespace
}  // namespace plumbline::sim
