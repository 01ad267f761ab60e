// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/imu_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "sim/robot/sensors.h"

namespace plumbline::sim {
namespace {

TEST(ImuError, OfNothingIsNone) { EXPECT_FALSE(draw(ImuError{}, 1)); }

TEST(ImuError, EachAxisIsOffByTheSizeWithASignOfItsOwn) {
  const ImuError error{0.002, 0.05, 0.01};
  std::set<int> signs;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto drawn = draw(error, seed);
    ASSERT_TRUE(drawn);
    int bits = 0;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_DOUBLE_EQ(std::abs(drawn->gyro_bias_R(axis)), 0.002);
      EXPECT_DOUBLE_EQ(std::abs(drawn->accelerometer_bias_R(axis)), 0.05);
      EXPECT_NEAR(std::abs(drawn->gyro_scale(axis) - 1.0), 0.01, 1e-15);
      EXPECT_NEAR(std::abs(drawn->accelerometer_scale(axis) - 1.0), 0.01, 1e-15);
      bits |= (drawn->gyro_bias_R(axis) > 0.0 ? 1 : 0) << axis;
    }
    signs.insert(bits);
  }
  EXPECT_EQ(signs.size(), 8U);
}

TEST(ImuError, IsInTheReadingsAndLeavesTheNoiseAlone) {
  Proprioception truth;
  truth.gyro_R = {0.1, -0.2, 0.3};
  truth.accelerometer_R = {0.1, 0.2, 9.81};
  const ImuError error{0.002, 0.05, 0.01};
  const auto drawn = draw(error, 4);
  ProprioceptiveSensors right(OdometryPreset::noisy, 4), wrong(OdometryPreset::noisy, 4, error);
  for (std::int64_t tick = 0; tick < 50; ++tick) {
    const SensorReading a = right.read(truth, tick), b = wrong.read(truth, tick);
    EXPECT_LT((b.gyro_R - a.gyro_R - (drawn->gyro_R(truth.gyro_R) - truth.gyro_R)).norm(), 1e-12);
    EXPECT_LT((b.accelerometer_R - a.accelerometer_R -
               (drawn->accelerometer_R(truth.accelerometer_R) - truth.accelerometer_R))
                  .norm(),
              1e-12);
    EXPECT_EQ(a.q, b.q);
    EXPECT_EQ(a.qd, b.qd);
    EXPECT_EQ(a.contact, b.contact);
  }
}

}  // namespace
}  // namespace plumbline::sim
