// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/degraded_recording.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace plumbline::scenarios {
namespace {

constexpr slam::Nanoseconds tenth = 100'000'000;

/// Scan i is at (i + 1) * 0.1 s, with two records of odometry, five of the IMU and one covariance before it.
slam::SensorFrame frame_at(int i) {
  slam::SensorFrame frame;
  const slam::Nanoseconds stamp = (i + 1) * tenth;
  for (int k = 4; k >= 0; --k) {
    frame.imu.emplace_back();
    frame.imu.back().stamp = stamp - k * tenth / 5;
  }
  for (int k = 1; k >= 0; --k) frame.odometry.push_back({stamp - k * tenth / 2, Pose()});
  frame.covariances.emplace_back();
  frame.covariances.back().stamp = stamp;
  frame.packets.resize(3);
  slam::Scan& scan = frame.scan;
  scan.stamp = stamp;
  scan.rings = 4;
  scan.columns = 6;
  for (int slot = 0; slot < 24; ++slot) {
    const bool hit = slot % 5 != 0;
    scan.range_m.push_back(hit ? 1.0 + slot : 0.0);
    scan.point_L.emplace_back(hit ? Eigen::Vector3d(1.0 + slot, 0.0, 0.0) : Eigen::Vector3d::Zero());
    scan.reflectivity.push_back(static_cast<float>(slot));
    scan.offset_ns.push_back(1000 * (slot - 23));
  }
  return frame;
}

class Walk final : public slam::Recording {
 public:
  explicit Walk(int scans, slam::SensorFrame (*frame)(int) = frame_at) : scans_(scans), frame_(frame) {}
  [[nodiscard]] bool next(slam::SensorFrame& frame) override {
    if (at_ == scans_) return false;
    frame = frame_(at_++);
    return true;
  }
  [[nodiscard]] const slam::RecordingInfo& info() const override { return info_; }
  [[nodiscard]] bool has_odometry() const override { return true; }
  [[nodiscard]] slam::Taken taken() const override { return {}; }
  [[nodiscard]] slam::Nanoseconds origin() const override { return 77; }

 private:
  int scans_, at_ = 0;
  slam::SensorFrame (*frame_)(int);
  slam::RecordingInfo info_;
};

std::vector<slam::SensorFrame> read(int scans, const Degradation& degradation) {
  const auto recording = degraded(std::make_unique<Walk>(scans), degradation);
  EXPECT_EQ(recording->origin(), 77);
  EXPECT_TRUE(recording->has_odometry());
  std::vector<slam::SensorFrame> frames;
  for (slam::SensorFrame frame; recording->next(frame);) frames.push_back(frame);
  return frames;
}

TEST(DegradedRecording, EveryThirdScanComesWithAllRecordsSinceTheOneBefore) {
  const auto frames = read(9, {.every = 3});
  ASSERT_EQ(frames.size(), 3U);  // scans 0, 3 and 6; 7 and 8 are followed by none
  slam::Nanoseconds imu = 0, odometry = 0, covariance = 0;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    EXPECT_EQ(frames[f].scan.stamp, static_cast<slam::Nanoseconds>(3 * f + 1) * tenth);
    EXPECT_EQ(frames[f].imu.size(), f == 0 ? 5U : 15U);
    EXPECT_EQ(frames[f].odometry.size(), f == 0 ? 2U : 6U);
    EXPECT_EQ(frames[f].covariances.size(), f == 0 ? 1U : 3U);
    EXPECT_EQ(frames[f].packets.size(), 3U);
    for (const slam::Imu& record : frames[f].imu) EXPECT_EQ(record.stamp - std::exchange(imu, record.stamp), tenth / 5);
    for (const slam::Odometry& record : frames[f].odometry)
      EXPECT_EQ(record.stamp - std::exchange(odometry, record.stamp), tenth / 2);
    for (const slam::OdometryCovariance& record : frames[f].covariances)
      EXPECT_EQ(record.stamp - std::exchange(covariance, record.stamp), tenth);
  }
}

TEST(DegradedRecording, ARecordingThatIsTooShortHasItsFirstScan) {
  EXPECT_EQ(read(3, {.every = 1000}).size(), 1U);
  EXPECT_EQ(read(0, {.every = 2}).size(), 0U);
}

TEST(DegradedRecording, WithoutRingsThePointsStayInTheirOrder) {
  const slam::Scan whole = frame_at(0).scan;
  const slam::SensorFrame frame = read(1, {.no_rings = true}).front();
  EXPECT_EQ(frame.scan.rings, 1);
  EXPECT_EQ(frame.scan.columns, 24);
  EXPECT_EQ(frame.scan.range_m, whole.range_m);
  EXPECT_EQ(frame.scan.point_L, whole.point_L);
  EXPECT_EQ(frame.scan.reflectivity, whole.reflectivity);
  EXPECT_EQ(frame.scan.offset_ns, whole.offset_ns);
  EXPECT_TRUE(frame.packets.empty()) << "they would tell";
}

TEST(DegradedRecording, WithoutTimesEveryReturnHasTheStampOfTheScan) {
  const slam::Scan whole = frame_at(0).scan;
  const slam::SensorFrame frame = read(1, {.no_times = true}).front();
  EXPECT_EQ(frame.scan.rings, 4);
  EXPECT_EQ(frame.scan.columns, 6);
  EXPECT_EQ(frame.scan.stamp, whole.stamp);
  EXPECT_EQ(frame.scan.point_L, whole.point_L);
  EXPECT_EQ(frame.scan.offset_ns, std::vector<std::int32_t>(24, 0));
}

/// Indices of returns that are kept; those that are not leave their slots empty.
std::vector<int> kept(const slam::SensorFrame& frame) {
  EXPECT_TRUE(frame.packets.empty()) << "they would tell";
  EXPECT_EQ(frame.scan.size(), 24U);
  std::vector<int> all;
  for (std::size_t i = 0; i < frame.scan.size(); ++i) {
    EXPECT_EQ(frame.scan.range_m[i] > 0.0, !frame.scan.point_L[i].isZero(0.0));
    if (frame.scan.range_m[i] > 0.0) all.push_back(static_cast<int>(i));
  }
  return all;
}

TEST(DegradedRecording, ReturnsFartherThanItsRangeAreLost) {
  EXPECT_EQ(kept(read(1, {.within_m = 5.0}).front()), (std::vector<int>{1, 2, 3, 4}));
}

TEST(DegradedRecording, OfThreeReturnsOneIsDrawnTheSameEachTime) {
  const auto some = read(40, {.one_of = 3}), again = read(40, {.one_of = 3});
  std::size_t number = 0;
  for (std::size_t f = 0; f < some.size(); ++f) {
    EXPECT_EQ(kept(some[f]), kept(again[f]));
    number += kept(some[f]).size();
  }
  EXPECT_NE(kept(some[0]), kept(some[1]));
  // Of 760 returns; four standard deviations.
  EXPECT_NEAR(static_cast<double>(number), 760.0 / 3.0, 4.0 * std::sqrt(760.0 * 2.0 / 9.0));
}

/// A return each tenth of a degree, 10 degrees up and down.
slam::SensorFrame fan(int) {
  slam::SensorFrame frame;
  for (int tenths = -100; tenths <= 100; ++tenths) {
    const double elevation = 0.1 * tenths * std::numbers::pi / 180.0;
    frame.scan.range_m.push_back(10.0);
    frame.scan.point_L.emplace_back(10.0 * std::cos(elevation), 0.0, 10.0 * std::sin(elevation));
    frame.scan.offset_ns.push_back(0);
  }
  return frame;
}

TEST(DegradedRecording, BeamsAreSpreadOverTheElevations) {
  const auto recording = degraded(std::make_unique<Walk>(1, fan), {.beams = 3});
  slam::SensorFrame frame;
  ASSERT_TRUE(recording->next(frame));
  std::vector<int> tenths;
  for (int i = 0; i <= 200; ++i)
    if (frame.scan.range_m[static_cast<std::size_t>(i)] > 0.0) tenths.push_back(i - 100);
  // Thirds of -9 to 9 degrees, and 0.12 degrees about the middle of each.
  EXPECT_EQ(tenths, (std::vector<int>{-61, -60, -59, -1, 0, 1, 59, 60, 61}));
}

TEST(DegradedRecording, ARecordingOfWhichNothingIsKeptBackIsItself) {
  auto walk = std::make_unique<Walk>(2);
  const slam::Recording* same = walk.get();
  EXPECT_EQ(degraded(std::move(walk), {}).get(), same);
}

}  // namespace
}  // namespace plumbline::scenarios
