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

  static std::vector<Nanoseconds> stamps_of(const std::string& path) {
    std::vector<Nanoseconds> stamps;
    const auto recording = open_bag(path, {}, nullptr);
    for (SensorFrame frame; recording->next(frame);) {
      for (const Imu& imu : frame.imu) stamps.push_back(imu.stamp);
      stamps.push_back(frame.scan.stamp);
    }
    return stamps;
  }
  static std::string error_of(const std::string& path) {
    return input_error([&] { (void)stamps_of(path); });
  }

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
  run_sql(file("back/back_0.db3"), "UPDATE messages SET timestamp = id;");  // recorded as they came
  const std::string complaint = error_of(file("back"));
  EXPECT_EQ(complaint.rfind(file("back"), 0), 0U) << complaint;
  EXPECT_NE(complaint.find("go back by 1496 ms; records that come late by at most 1000 ms would be left out"),
            std::string::npos)
      << complaint;
}

// A player sorts by the time of recording, too.
TEST_F(LateRecords, RowsThatAreOutOfOrderAreSorted) {
  write_walk(file("walk"), BagFormat::rosbag2);
  const std::string database = file("walk/walk_0.db3");
  const std::vector<Nanoseconds> expected = stamps_of(database);
  swap_rows(database, "/velodyne_points", 1);
  swap_rows(database, "/imu/data", 5);
  EXPECT_EQ(stamps_of(database), expected);
  run_sql(database, "DROP INDEX timestamp_idx;");
  EXPECT_EQ(stamps_of(database), expected);
}

TEST_F(LateRecords, ScansOfOneStampAreCountedAndMostlyRefused) {
  const auto write = [&](const std::string& name, std::size_t at_rest) {
    std::vector<SensorFrame> frames = walk_of_four_scans();
    for (std::size_t i = 1; i <= at_rest; ++i) frames[i].scan.stamp = frames[0].scan.stamp;
    BagWriter writer(file(name), bag_profiles[0], {}, BagFormat::rosbag2);
    for (const SensorFrame& frame : frames) writer.add(frame.scan, frame.odometry, frame.imu);
    writer.finish();
    return file(name);
  };
  const auto recording = open_bag(write("some", 2), {}, nullptr);
  for (SensorFrame frame; recording->next(frame);) continue;
  ASSERT_EQ(recording->left_out().size(), 1U);
  EXPECT_EQ(recording->left_out()[0], "/velodyne_points: 2 of 4 scans left out: same stamp as the one before");
  EXPECT_NE(error_of(write("most", 3)).find("/velodyne_points: 3 of 4 scans have a stamp"), std::string::npos)
      << error_of(file("most"));
}

TEST_F(LateRecords, OdometryOfOneStampIsRefused) {
  std::vector<SensorFrame> frames = walk_of_four_scans();
  for (SensorFrame& frame : frames)
    for (Odometry& odometry : frame.odometry) odometry.stamp = 0;
  BagWriter writer(file("still"), bag_profiles[0], {}, BagFormat::rosbag2);
  for (const SensorFrame& frame : frames) writer.add(frame.scan, frame.odometry, frame.imu);
  writer.finish();
  EXPECT_NE(error_of(file("still")).find("/odom: all records have one stamp"), std::string::npos)
      << error_of(file("still"));
}

TEST_F(LateRecords, ScansBeforeTheOdometryAreCounted) {
  std::vector<SensorFrame> frames = walk_of_four_scans();
  frames[0].odometry.clear();
  BagWriter writer(file("early"), bag_profiles[0], {}, BagFormat::rosbag2);
  for (const SensorFrame& frame : frames) writer.add(frame.scan, frame.odometry, frame.imu);
  writer.finish();
  const auto recording = open_bag(file("early"), {}, nullptr);
  for (SensorFrame frame; recording->next(frame);) continue;
  ASSERT_EQ(recording->left_out().size(), 1U);
  EXPECT_EQ(recording->left_out()[0], "/velodyne_points: 1 of 4 scans left out: before the first odometry");
}

}  // namespace
}  // namespace plumbline::slam
