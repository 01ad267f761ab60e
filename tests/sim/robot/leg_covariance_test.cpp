// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/leg_covariance.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>

#include "sim/robot/types/kinematics.h"
#include "tests/sim/robot/physics_step.h"

namespace plumbline::sim {
namespace {

constexpr std::array<bool, 4> all = {true, true, true, true};
const Eigen::Vector3d walking(0.7, 0.0, 0.0);

SensorReading upright() {
  SensorReading reading;
  for (std::size_t leg = 0; leg < leg_count; ++leg) {
    const LegAngles q = leg_angles(leg, hip_R(leg) + Eigen::Vector3d(0.0, side_sign(leg) * 0.1, -0.45));
    std::copy_n(q.data(), 3, reading.q.begin() + static_cast<std::ptrdiff_t>(3 * leg));
  }
  return reading;
}

Matrix6d covariance(const std::array<bool, 4>& stands, const Eigen::Vector3d& v_R,
                    OdometryPreset preset = OdometryPreset::noisy) {
  LegCovarianceConfig config;
  config.noise = noise_of(preset);
  return leg_increment_covariance(config, upright(), stands, v_R, step_s);
}

TEST(LegCovariance, IsACovarianceInEveryCase) {
  for (int mask = 0; mask < 16; ++mask)
    for (const OdometryPreset preset : {OdometryPreset::ideal, OdometryPreset::noisy, OdometryPreset::uncorrected})
      for (const Eigen::Vector3d& v_R : {Eigen::Vector3d(0.0, 0.0, 0.0), walking, Eigen::Vector3d(0.3, -0.5, 0.1)}) {
        const Matrix6d m =
            covariance({(mask & 1) != 0, (mask & 2) != 0, (mask & 4) != 0, (mask & 8) != 0}, v_R, preset);
        EXPECT_LE((m - m.transpose()).norm(), 1e-15 * m.norm());
        if (preset == OdometryPreset::noisy) {
          EXPECT_EQ(Eigen::LLT<Matrix6d>(m).info(), Eigen::Success) << mask;
        }
        EXPECT_GE(m.diagonal().minCoeff(), 0.0);
      }
}

TEST(LegCovariance, MoreFeetKnowMoreAndNoFeetLittle) {
  const double one = covariance({true, false, false, false}, walking)(1, 1);
  const double two = covariance({true, false, false, true}, walking)(1, 1);
  const double four = covariance(all, walking)(1, 1);
  const double none = covariance({}, walking)(1, 1);
  EXPECT_LT(four, two);
  EXPECT_LT(two, one);
  EXPECT_GT(none, 10.0 * one);
}

TEST(LegCovariance, FasterIsLessCertainAlongTheWay) {
  const Matrix6d still = covariance(all, Eigen::Vector3d::Zero());
  const Matrix6d moving = covariance(all, walking);
  const ProprioceptionNoise noise = noise_of(OdometryPreset::noisy);
  const LegCovarianceConfig config;
  const double expected = (noise.leg_scale * noise.leg_scale + config.slip * config.slip) * 0.7 * 0.7 * step_s;
  EXPECT_NEAR(moving(0, 0) - still(0, 0), expected, 1e-9 * expected);
  EXPECT_EQ(moving(5, 5), still(5, 5));
}

TEST(LegCovariance, NoiseFreeSensorsLeaveTheModelsErrors) {
  const Matrix6d ideal = covariance(all, walking, OdometryPreset::ideal);
  const Matrix6d noisy = covariance(all, walking);
  for (int i = 0; i < 6; ++i) {
    EXPECT_GT(ideal(i, i), 0.0) << i;
    EXPECT_LE(ideal(i, i), noisy(i, i)) << i;
  }
}

}  // namespace
}  // namespace plumbline::sim
