// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/unset_clock.h"

#include <gtest/gtest.h>

#include "tests/input_error.h"

namespace plumbline::slam {
namespace {

constexpr Nanoseconds today = 1'700'000'000 * second_ns;

TEST(UnsetClock, LeavesOutWhatIsStampedBeforeItWasSet) {
  UnsetClock clock;
  EXPECT_TRUE(clock.add(5 * second_ns));
  EXPECT_FALSE(clock.add(today));
  EXPECT_FALSE(clock.takes(5 * second_ns, "/points"));
  EXPECT_TRUE(clock.takes(today, "/points"));
  EXPECT_TRUE(clock.takes(today, "/odom"));
  EXPECT_EQ(clock.left_out(), std::vector<std::string>{
                                  "/points: 1 of 2 records left out: stamped before 2000, when the clock was not set"});
}

TEST(UnsetClock, ASimulationsClockIsLeftAlone) {
  UnsetClock clock;
  int asked = 0;
  while (asked < 1000 && clock.add(asked * second_ns / 10)) ++asked;
  EXPECT_LT(asked, 1000);
  EXPECT_TRUE(clock.takes(0, "/points"));
  EXPECT_TRUE(clock.takes(second_ns, "/points"));
  EXPECT_TRUE(clock.left_out().empty());
  EXPECT_FALSE(clock.takes(-1, "/odom"));  // ROS 2 has such
  EXPECT_EQ(clock.left_out().size(), 1U);
  const std::string error = input_error([&] { (void)clock.takes(today, "/points"); });
  EXPECT_NE(error.find("stamps on /points leap to this century"), std::string::npos) << error;
}

}  // namespace
}  // namespace plumbline::slam
