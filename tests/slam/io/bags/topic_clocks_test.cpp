// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/topic_clocks.h"

#include <gtest/gtest.h>

namespace plumbline::slam {
namespace {

constexpr Nanoseconds second = 1'000'000'000;

TEST(TopicClocksTest, SaysHowFarStampsAreApart) {
  const auto said = [](Nanoseconds scan, Nanoseconds odometry) {
    TopicClocks clocks;
    clocks.add_scan(scan, 100 * second);
    clocks.add_odometry(odometry, 103 * second);
    clocks.add_scan(scan + second, 101 * second);
    clocks.add_scan(500 * second, 100 * second);  // one of three may be wrong,
    clocks.add_scan(500 * second, 100 * second);  // and later ones do not count
    return clocks.difference("/a", "/b");
  };
  EXPECT_EQ(said(137 * second, 103 * second),
            "the stamps on /a are 37.0 s ahead of those on /b, by the times of recording");
  EXPECT_EQ(said(50 * second, 103 * second),
            "the stamps on /a are 50.0 s behind those on /b, by the times of recording");
  EXPECT_EQ(said(100 * second, 101 * second), "");            // an odometry that takes long to compute
  EXPECT_EQ(said(3 * 3600 * second, 3 * 3600 * second), "");  // a bag recorded again
}

TEST(TopicClocksTest, AFirstScanWithoutAStampTellsNothing) {
  TopicClocks clocks;
  clocks.add_scan(0, 100 * second);
  clocks.add_odometry(100 * second, 100 * second);
  for (Nanoseconds t : {101 * second, 102 * second}) clocks.add_scan(t, t);
  EXPECT_EQ(clocks.difference("/a", "/b"), "");
}

TEST(TopicClocksTest, AnImuMayBeOnAnotherClock) {
  TopicClocks clocks;
  clocks.add_scan(137 * second, 100 * second);
  clocks.add_odometry(138 * second, 101 * second);
  clocks.add_imu(100 * second, 100 * second);
  EXPECT_EQ(clocks.difference("/a", "/b"), "");
  EXPECT_EQ(clocks.imu_difference("/a", "/imu"),
            "the stamps on /a are 37.0 s ahead of those on /imu, by the times of recording");
}

TEST(TopicClocksTest, StampsMayBeCenturiesApart) {
  constexpr Nanoseconds far = 4'000'000'000 * second - 1;
  TopicClocks clocks;
  clocks.add_scan(far, -far);
  clocks.add_odometry(-far, far);
  EXPECT_EQ(clocks.difference("/a", "/b"),
            "the stamps on /a are 16000000000.0 s ahead of those on /b, by the times of recording");
}

TEST(TopicClocksTest, OneTopicTellsNothing) {
  TopicClocks clocks;
  clocks.add_scan(0, 100 * second);
  EXPECT_EQ(clocks.difference("/a", ""), "");
}

}  // namespace
}  // namespace plumbline::slam
