// SPDX-License-Identifier: Apache-2.0
#include "slam/io/recordings/motion_files.h"

#include <gtest/gtest.h>

#include <fstream>
#include <vector>

#include "tests/folder.h"
#include "tests/input_error.h"

namespace plumbline::slam {
namespace {

/// Scans without returns at these stamps, on a clock that starts at `origin`.
class Scans final : public Recording {
 public:
  Scans(std::vector<Nanoseconds> stamps, Nanoseconds origin) : stamps_(std::move(stamps)), origin_(origin) {}
  [[nodiscard]] bool next(SensorFrame& frame) override {
    if (next_ == stamps_.size()) return false;
    frame = {};
    frame.scan.stamp = stamps_[next_++];
    return true;
  }
  [[nodiscard]] const RecordingInfo& info() const override { return info_; }
  [[nodiscard]] bool has_odometry() const override { return false; }
  [[nodiscard]] Nanoseconds origin() const override { return origin_; }
  [[nodiscard]] Taken taken() const override { return {}; }

 private:
  std::vector<Nanoseconds> stamps_;
  Nanoseconds origin_;
  RecordingInfo info_;
  std::size_t next_ = 0;
};

constexpr Nanoseconds s = 1'000'000'000;

class MotionFilesTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::string put(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  /// What four scans, a second apart from 1 s on, get.
  static std::vector<SensorFrame> frames(const MotionFiles& files, Nanoseconds origin = 0) {
    const auto recording = with_motion(std::make_unique<Scans>(std::vector{s, 2 * s, 3 * s, 4 * s}, origin), files);
    std::vector<SensorFrame> all;
    for (SensorFrame frame; recording->next(frame);) all.push_back(frame);
    return all;
  }
  static std::string complaint(const MotionFiles& files) {
    return input_error([&] { (void)frames(files); });
  }

 private:
  Folder folder_;
};

TEST_F(MotionFilesTest, RecordsComeWithTheScanThatEndsAfterThem) {
  const std::string tum = put("odometry.tum", "1001.5 1 0 0 0 0 0 1\n1002 2 0 0 0 0 0 1\n1003.1 3 0 0 0 0 0 1\n");
  const std::string imu = put("imu.csv", "t,wx,wy,wz,ax,ay,az\n1000.5,0,0,1,0,0,9.8\n1002.5,0,0,2,0,0,9.8\n");
  const std::vector<SensorFrame> got = frames({tum, imu}, 1000 * s);
  ASSERT_EQ(got.size(), 3U) << "the first scan is before the odometry";
  ASSERT_EQ(got[0].odometry.size(), 2U);
  EXPECT_EQ(got[0].odometry[0].stamp, 3 * s / 2);
  EXPECT_EQ(got[0].odometry[1].X_OR.t.x(), 2.0);
  EXPECT_TRUE(got[1].odometry.empty());
  EXPECT_EQ(got[2].odometry.size(), 1U);
  ASSERT_EQ(got[1].imu.size(), 1U);
  EXPECT_EQ(got[1].imu[0].stamp, 5 * s / 2);
  EXPECT_EQ(got[1].imu[0].angular_velocity_R.z(), 2.0);
}

TEST_F(MotionFilesTest, WhatIsReadIsSaid) {
  const std::string tum = put("wheels.tum", "2 1 0 0 0 0 0 1\n");
  const auto recording = with_motion(std::make_unique<Scans>(std::vector{s, 2 * s}, 0), {tum, {}});
  EXPECT_TRUE(recording->has_odometry());
  EXPECT_EQ(recording->taken().odometry, "wheels.tum");
  for (SensorFrame frame; recording->next(frame);) continue;
  ASSERT_EQ(recording->left_out().size(), 1U);
  EXPECT_EQ(recording->left_out()[0], "1 of 2 scans left out: before the first odometry");
}

TEST_F(MotionFilesTest, FormsOfOthersAreRead) {
  const std::string kitti = put("poses.txt",
                                "1 0 0 1 0 1 0 0 0 0 1 0\n1 0 0 2 0 1 0 0 0 0 1 0\n1 0 0 3 0 1 0 0 0 0 1 0\n"
                                "1 0 0 4 0 1 0 0 0 0 1 0\n");
  const std::vector<SensorFrame> of_scans = frames({kitti, {}});
  ASSERT_EQ(of_scans.size(), 4U);
  EXPECT_EQ(of_scans[2].odometry.at(0).stamp, 3 * s);
  EXPECT_EQ(of_scans[2].odometry.at(0).X_OR.t.x(), 3.0);
  const std::string euroc = put("odometry.csv", "#timestamp\n1000000000,5,0,0,1,0,0,0\n");
  EXPECT_EQ(frames({euroc, {}}).at(0).odometry.at(0).X_OR.t.x(), 5.0);
  const std::string data =
      put("data.csv", "#timestamp [ns],w_x\n1000000000,0.1,0.2,0.3,1,2,9\n2000000000,0,0,0,1,2,9\n");
  const std::vector<SensorFrame> inertial = frames({{}, data});
  EXPECT_EQ(inertial.at(0).imu.at(0).angular_velocity_R, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(inertial.at(1).imu.at(0).linear_acceleration_R, Eigen::Vector3d(1, 2, 9));
}

TEST_F(MotionFilesTest, TheImuOfScansBeforeTheOdometryIsKept) {
  const std::string tum = put("odometry.tum", "2.5 1 0 0 0 0 0 1\n");
  const std::string imu = put("data.csv", "500000000, 0, 0, 1, 0, 0, 9.8\n1500000000, 0, 0, 2, 0, 0, 9.8\n");
  const std::vector<SensorFrame> got = frames({tum, imu});
  ASSERT_EQ(got.size(), 2U);
  EXPECT_EQ(got[0].imu.size(), 2U);
  EXPECT_TRUE(got[1].imu.empty());
}

TEST_F(MotionFilesTest, FilesMayBeginWithAByteOrderMark) {
  const std::string kitti = put("poses.txt", "\xEF\xBB\xBF" + std::string("1 0 0 1 0 1 0 0 0 0 1 0\n") +
                                                 "1 0 0 2 0 1 0 0 0 0 1 0\n1 0 0 3 0 1 0 0 0 0 1 0\n"
                                                 "1 0 0 4 0 1 0 0 0 0 1 0\n");
  EXPECT_EQ(frames({kitti, {}}).size(), 4U);
  const std::string imu = put("data.csv", "\xEF\xBB\xBF" + std::string("1000000000,0,0,0,0,0,9.8\n"));
  EXPECT_EQ(frames({{}, imu}).at(0).imu.size(), 1U);
}

TEST_F(MotionFilesTest, AnImuOnAnotherClockIsRefused) {
  const std::string said = ": no record of the IMU lies within the time of the scans; are both on one clock?";
  const std::string late = put("late.csv", "1700000000000000000,0,0,0,0,0,9.8\n");
  EXPECT_EQ(complaint({{}, late}), late + said);
  const std::string early = put("early.csv", "-9000000000,0,0,0,0,0,9.8\n");
  EXPECT_EQ(complaint({{}, early}), early + said);
  const std::string never = put("never.csv", "-9223372036854775808,0,0,0,0,0,9.8\n");
  EXPECT_EQ(complaint({{}, never}).rfind(never + ":1:1: is no line of an IMU", 0), 0U);
  const std::string ages = put("ages.tum", "-9000000000 0 0 0 0 0 0 1\n");
  EXPECT_EQ(complaint({ages, {}}), ages + ":1:1: '-9000000000' is no time in seconds; is it in nanoseconds?");
}

TEST_F(MotionFilesTest, WhatDoesNotFitIsRefusedWithItsPlace) {
  const std::string late = put("late.tum", "5 0 0 0 0 0 0 1\n"), early = put("early.tum", "-9 0 0 0 0 0 0 1\n");
  EXPECT_EQ(complaint({late, {}}), late + ": " + std::string(no_odometry));
  EXPECT_EQ(complaint({early, {}}), early + ": " + std::string(odometry_over));
  const std::string none = put("none.tum", "# t x\n");
  EXPECT_EQ(complaint({none, {}}), none + ": holds no pose");
  EXPECT_EQ(complaint({{}, none}), none + ": holds no record of an IMU");
  const std::string binary = put("capture.pcap", std::string("M<\0\1", 4));
  EXPECT_EQ(complaint({binary, {}}).rfind(binary + ": is no text", 0), 0U) << complaint({binary, {}});
  for (const int lines : {3, 5}) {
    std::string text;
    for (int i = 0; i < lines; ++i) text += "1 0 0 0 0 1 0 0 0 0 1 0\n";
    const std::string kitti = put("poses.txt", text);
    EXPECT_NE(complaint({kitti, {}}).find("is not one for each scan"), std::string::npos) << lines;
  }
  const std::string odd = put("odd.csv", "1000000000,0,0,0,0,0,9.8\n2000000000,0,0,0,0,0\n");
  EXPECT_EQ(complaint({{}, odd}).rfind(odd + ":2:1: is no line of an IMU", 0), 0U) << complaint({{}, odd});
  const std::string back = put("back.csv", "2000000000,0,0,0,0,0,9.8\n1000000000,0,0,0,0,0,9.8\n");
  EXPECT_EQ(complaint({{}, back}), back + ":2:1: stamps must increase from line to line");
}

TEST_F(MotionFilesTest, ARecordingThatHasItsOwnKeepsIt) {
  const std::string tum = put("odometry.tum", "1 0 0 0 0 0 0 1\n");
  const std::string imu = put("imu.csv", "1000000000,0,0,0,0,0,9.8\n");
  const auto two = [](const MotionFiles& first, const MotionFiles& second) {
    return input_error([&] {
      auto inner = with_motion(std::make_unique<Scans>(std::vector{s}, 0), first);
      const auto outer = with_motion(std::move(inner), second);
      for (SensorFrame frame; outer->next(frame);) continue;
    });
  };
  EXPECT_EQ(two({tum, {}}, {tum, {}}), tum + ": the recording has odometry of its own; without this file it is read");
  EXPECT_EQ(two({{}, imu}, {{}, imu}), imu + ": the recording has an IMU of its own; without this file it is read");
}

}  // namespace
}  // namespace plumbline::slam
