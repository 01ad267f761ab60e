// SPDX-License-Identifier: Apache-2.0
// Records of a bag that come after newer ones of their topic.
#include <gtest/gtest.h>

#include <tuple>

#include "tests/bag_database.h"
#include "tests/folder.h"
#include "tests/input_error.h"
#include "tests/slam/io/bags/bag_of_four_scans.h"

namespace plumbline::slam {
namespace {

class LateRecords : public ::testing::Test {
 protected:
  [[nodiscard]] std::string file(const std::string& name) const { return folder_ / name; }

 private:
  Folder folder_;
};

// Two threads of a driver may swap their records.
TEST_F(LateRecords, AreLeftOutAndCounted) {
  write_walk(file("walk"), BagFormat::rosbag2);
  const std::string database = file("walk/walk_0.db3");
  const auto counted = [&] {
    const auto recording = open_bag(database, {}, nullptr);
    std::size_t scans = 0, imu = 0, odometry = 0;
    for (SensorFrame frame; recording->next(frame);) {
      ++scans;
      imu += frame.imu.size();
      odometry += frame.odometry.size();
      EXPECT_LE(frame.covariances.size(), frame.odometry.size());
    }
    return std::tuple(scans, imu, odometry, recording->left_out());
  };
  const auto [scans, imu, odometry, none] = counted();
  EXPECT_TRUE(none.empty());
  swap_messages(database, "/imu/data", 5);
  swap_messages(database, "/odom", 7);
  swap_messages(database, "/odom", 12);
  swap_messages(database, "/velodyne_points", 1);
  const auto [scans_left, imu_left, odometry_left, said] = counted();
  EXPECT_EQ(scans_left + 1, scans);
  EXPECT_EQ(imu_left + 1, imu);
  EXPECT_EQ(odometry_left + 2, odometry);
  ASSERT_EQ(said.size(), 3U);
  EXPECT_EQ(said[0].rfind("/velodyne_points: 1 record left out, as stamps go back by up to 10", 0), 0U) << said[0];
  EXPECT_EQ(said[1], "/odom: 2 records left out, as stamps go back by up to 10 ms");
  EXPECT_EQ(said[2], "/imu/data: 1 record left out, as stamps go back by up to 4 ms");
}

// What follows is of another recording.
TEST_F(LateRecords, AClockThatIsSetBackIsRefused) {
  std::vector<SensorFrame> frames = walk_of_four_scans();
  for (Imu& imu : frames[1].imu) imu.stamp += 1'500'000'000;
  BagWriter writer(file("back"), bag_profiles[0], {}, BagFormat::rosbag2);
  for (const SensorFrame& frame : frames) writer.add(frame.scan, frame.odometry, frame.imu);
  writer.finish();
  const std::string complaint = input_error([&] {
    const auto recording = open_bag(file("back"), {}, nullptr);
    for (SensorFrame frame; recording->next(frame);) {
    }
  });
  EXPECT_EQ(complaint.rfind(file("back"), 0), 0U) << complaint;
  EXPECT_NE(complaint.find("go back by 1496 ms; records that come late by at most 1000 ms would be left out"),
            std::string::npos)
      << complaint;
}

}  // namespace
}  // namespace plumbline::slam
