// SPDX-License-Identifier: Apache-2.0
#include "sim/faults.h"

#include <gtest/gtest.h>

namespace plumbline::sim {
namespace {

TEST(Faults, HarshHasEveryErrorAndNoneHasNone) {
  const Faults none = faults_of(FaultsPreset::none), harsh = faults_of(FaultsPreset::harsh);
  EXPECT_EQ(none.clock.offset_s, 0.0);
  EXPECT_EQ(none.clock.jitter_s, 0.0);
  EXPECT_EQ(none.mount.length_m, 0.0);
  EXPECT_EQ(none.mount.angle_rad, 0.0);
  EXPECT_FALSE(draw(none.imu, 1));
  EXPECT_EQ(none.slip.speed_mps, 0.0);
  EXPECT_GT(harsh.clock.offset_s, 0.0);
  EXPECT_GT(harsh.clock.jitter_s, 0.0);
  EXPECT_GT(harsh.mount.length_m, 0.0);
  EXPECT_GT(harsh.mount.angle_rad, 0.0);
  EXPECT_TRUE(draw(harsh.imu, 1));
  EXPECT_GT(harsh.slip.speed_mps, 0.0);
}

}  // namespace
}  // namespace plumbline::sim
