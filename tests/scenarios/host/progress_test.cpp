// SPDX-License-Identifier: Apache-2.0
#include "scenarios/host/progress.h"

#include <gtest/gtest.h>

namespace plumbline::scenarios {
namespace {

TEST(Progress, SaysHowFarHowFastAndHowLongStill) {
  EXPECT_EQ(progress_text(60.0, {240.0, "s", true}, 20.0, true),
            "[#####...............] 60 of at most 240 s, 3 times as fast as real, at most 1:00 left");
  EXPECT_EQ(progress_text(60.0, {240.0, "s", true}, 20.0, false),
            "60 of at most 240 s, 3 times as fast as real, at most 1:00 left");
  EXPECT_EQ(progress_text(5.0, {20.0, "runs"}, 600.0, false), "5 of 20 runs, 0.5 a minute, 30:00 left");
  EXPECT_EQ(progress_text(100.0, {20000.0, "places"}, 50.0, false), "100 of 20000 places, 2 a second, 2:45:50 left");
}

TEST(Progress, ClaimsNoEndThatItDoesNotKnow) {
  const std::string text = progress_text(34.0, {}, 4.0, true);
  EXPECT_EQ(text, "34 s, 8.5 times as fast as real");
}

TEST(Progress, GivesNoRateAtTheBegin) {
  EXPECT_EQ(progress_text(0.0, {20.0, "runs"}, 100.0, false), "0 of 20 runs");
  EXPECT_EQ(progress_text(3.0, {20.0, "runs"}, 0.5, false), "3 of 20 runs");
}

TEST(Progress, FitsALineAndOverrunsGracefully) {
  EXPECT_LT(progress_text(1e5, {1e6, "s", true}, 1e5, true).size(), 100U);
  EXPECT_NE(progress_text(30.0, {20.0, "s"}, 10.0, true).find("[####################] 30 of 20 s"), std::string::npos);
}

}  // namespace
}  // namespace plumbline::scenarios
