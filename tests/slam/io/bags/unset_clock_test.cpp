// SPDX-License-Identifier: Apache-2.0
// Clocks that are set late, and the times of points beside them.
#include "slam/io/bags/unset_clock.h"

#include <gtest/gtest.h>

#include <utility>

#include "slam/io/bags/first_clouds.h"
#include "tests/folder.h"
#include "tests/input_error.h"
#include "tests/slam/io/bags/altered_walk.h"
#include "tests/slam/io/packets/turning_cloud.h"

namespace plumbline::slam {
namespace {

constexpr Nanoseconds today = 1'700'000'000 * second_ns;

TEST(UnsetClock, LeavesOutWhatIsStampedBeforeItWasSet) {
  UnsetClock clock;
  EXPECT_TRUE(clock.add(5 * second_ns));
  EXPECT_TRUE(clock.add(today));
  EXPECT_FALSE(clock.add(today + second_ns));
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
  EXPECT_TRUE(clock.takes(today, "/points"));
  const std::string error = input_error([&] { (void)clock.takes(today + second_ns, "/points"); });
  EXPECT_NE(error.find("stamps on /points leap to this century, as the clock was set after 2 records"),
            std::string::npos)
      << error;
}

TEST(UnsetClock, ATopicThatWasNeverEarlyDoesNotLeap) {
  UnsetClock clock;
  for (int i = 0; i < 3; ++i) static_cast<void>(clock.add(i * second_ns));
  for (int i = 0; i < 10; ++i) {
    EXPECT_TRUE(clock.takes(i * second_ns, "/points"));
    EXPECT_TRUE(clock.takes(today + i * second_ns, "/imu"));
  }
}

TEST(UnsetClock, OneLateStampAloneIsNoLeap) {
  UnsetClock clock;
  for (const int i : {0, 1, 2, 3}) EXPECT_TRUE(clock.add(i == 2 ? today : i * second_ns));
  for (const int i : {0, 1, 2, 3, 4, 5})
    EXPECT_TRUE(clock.takes(i == 2 || i == 4 ? today : i * second_ns, "/points")) << i;
  EXPECT_TRUE(clock.left_out().empty());
  UnsetClock of_one_cloud;
  EXPECT_TRUE(of_one_cloud.add(today));
  EXPECT_TRUE(of_one_cloud.leaves_out(second_ns));
}

/// How many scans are read, and what is said to be left out.
std::pair<std::size_t, std::vector<std::string>> read_walk(const Alteration& alteration) {
  const Folder folder;
  const std::string path = folder / "walk";
  write_altered(path, alteration);
  const auto recording = open_bag(path, {}, nullptr);
  std::size_t scans = 0;
  for (SensorFrame frame; recording->next(frame);) ++scans;
  return {scans, recording->left_out()};
}

// As of a LiDAR that counts from its start, beside an IMU with the computer's clock.
TEST(UnsetClock, ABagOfTwoClocksIsReadAndTheirDifferenceSaid) {
  Alteration apart;
  apart.imu = [](int, ros::FramedImu& message) { message.imu.stamp += today; };
  const auto [scans, left_out] = read_walk(apart);
  EXPECT_EQ(scans, 4U);
  ASSERT_EQ(left_out.size(), 1U);
  EXPECT_EQ(left_out[0].rfind("the stamps on /velodyne_points are 1700000000.", 0), 0U) << left_out[0];
}

TEST(UnsetClock, OneLateStampOfASimulationIsLeftOutAlone) {
  for (const int late : {1, 2}) {
    Alteration altered;
    altered.cloud = [&](int i, PointCloud& cloud) { cloud.stamp += i == late ? today : 0; };
    const auto [scans, left_out] = read_walk(altered);
    EXPECT_EQ(scans, 3U) << late;
    ASSERT_EQ(left_out.size(), 1U) << late;
    EXPECT_NE(left_out[0].find("1 record left out, with stamps up to 1.7e+09 s ahead"), std::string::npos)
        << left_out[0];
  }
}

// Points have the time of the day, while the stamps of the first clouds have that of a clock which is not set.
TEST(UnsetClock, TimesOfPointsAreNotToldByCloudsThatAreLeftOut) {
  const ShowClouds show = [](const std::function<bool(const PointCloud&)>& add) {
    for (int k = 0; k < 30; ++k) {
      PointCloud cloud = turn_of_second(1'700'000'000.35 + 0.1 * k);
      if (k < 3) cloud.stamp = 7 * second_ns + k * second_ns / 10;
      if (!add(cloud)) return;
    }
  };
  EXPECT_EQ(times_of_clouds(show, clock_of_clouds(show)).times.base, TimeBase::second);
  EXPECT_EQ(times_of_clouds(show, UnsetClock()).times.base, TimeBase::unknown);
}

}  // namespace
}  // namespace plumbline::slam
