// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/mount_height.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

/// Scans of a robot that stands so high, tilted forwards.
std::vector<Scan> scans_from(double z_m, double pitch) {
  const Pose X_WR =
      Pose::from_xyz_yaw({4.0, 3.0, z_m}, 0.3) *
      Pose{Eigen::Quaterniond(Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY())), Eigen::Vector3d::Zero()};
  std::vector<Scan> scans;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    synthetic::WalkConfig config;
    config.seed = seed;
    scans.push_back(synthetic::standing_scan(synthetic::one_room(14.0, 9.0), X_WR, config));
  }
  return scans;
}

TEST(MountHeight, IsThatOverTheFloorSeen) {
  const Calibration calibration = synthetic::calibration();
  for (const double z_m : {0.3, 0.9})
    for (const double pitch : {0.0, 0.08}) {
      const std::optional<double> height = height_over_floor(scans_from(z_m, pitch), calibration, 1);
      ASSERT_TRUE(height.has_value()) << z_m;
      const Eigen::Vector3d lidar_W = Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) * calibration.X_RL.t;
      EXPECT_NEAR(*height, z_m + lidar_W.z(), 0.02) << z_m << ", " << pitch;
    }
}

// A crowned road between a car on either side.
TEST(MountHeight, OfARoadIsWhereTheLowestReturnsLie) {
  synthetic::House road = synthetic::one_room(40.0, 20.0);
  for (int k = 0; k < 10; ++k) {
    const double y = 10.0 + 0.5 * (k - 5);
    road.boxes.push_back({{0.0, y, 0.0}, {40.0, y + 0.5, 0.03 * (5.0 - std::abs(k - 4.5))}});
  }
  for (const double y : {5.0, 13.2}) road.boxes.push_back({{18.0, y, 0.0}, {22.0, y + 1.8, 1.4}});
  std::vector<Scan> scans = {
      synthetic::standing_scan(road, Pose::from_xyz_yaw({20.0, 10.0, 1.4}, 0.2), synthetic::WalkConfig())};
  scans[0].columns *= scans[0].rings;
  scans[0].rings = 1;
  const std::optional<double> height = height_over_floor(scans, synthetic::calibration(), 1);
  ASSERT_TRUE(height.has_value());
  EXPECT_NEAR(*height, 1.4 + synthetic::calibration().X_RL.t.z() - 0.07, 0.08);
}

// More returns end on the desk than on the floor, which begins behind it.
TEST(MountHeight, IsNotThatOverADesk) {
  synthetic::House office = synthetic::one_room(14.0, 9.0);
  office.boxes.push_back({{4.3, 1.5, 0.7}, {6.8, 4.5, 0.75}});
  const double z_m = 0.9;
  std::vector<Scan> scans;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    synthetic::WalkConfig config;
    config.seed = seed;
    scans.push_back(synthetic::standing_scan(office, Pose::from_xyz_yaw({4.0, 3.0, z_m}, 0.3), config));
  }
  const std::optional<double> height = height_over_floor(scans, synthetic::calibration(), 1);
  ASSERT_TRUE(height.has_value());
  EXPECT_NEAR(*height, z_m + synthetic::calibration().X_RL.t.z(), 0.05);
}

/// Scans in this order, and nothing else.
class Scans final : public Recording {
 public:
  explicit Scans(std::vector<Scan> scans) : scans_(std::move(scans)) {}
  [[nodiscard]] bool next(SensorFrame& frame) override {
    if (next_ == scans_.size()) return false;
    frame.scan = scans_[next_];
    frame.scan.stamp = static_cast<Nanoseconds>(next_++) * 100'000'000;
    return true;
  }
  [[nodiscard]] const RecordingInfo& info() const override { return info_; }
  [[nodiscard]] bool has_odometry() const override { return false; }
  [[nodiscard]] Nanoseconds origin() const override { return 0; }
  [[nodiscard]] Taken taken() const override { return {}; }

 private:
  std::vector<Scan> scans_;
  std::size_t next_ = 0;
  RecordingInfo info_;
};

TEST(MountHeight, OfARecordingIsByTheFirstTenScansThatShowIt) {
  std::vector<Scan> seen = scans_from(0.5, 0.0), all(25, seen.front());
  for (Scan& scan : all) std::fill(scan.range_m.begin(), scan.range_m.end(), 0.0);
  for (int i = 0; i < 6; ++i) all.push_back(seen[static_cast<std::size_t>(i) % seen.size()]);
  Scans later(all);
  const std::optional<double> height = height_over_floor(later, synthetic::calibration(), 1);
  ASSERT_TRUE(height.has_value());
  EXPECT_NEAR(*height, 0.5 + synthetic::calibration().X_RL.t.z(), 0.02);
  all.insert(all.begin(), 300, all.front());
  Scans too_late(all);
  EXPECT_FALSE(height_over_floor(too_late, synthetic::calibration(), 1).has_value()) << "after half a minute";
}

// Behind a window, half a metre lower than the floor.
TEST(MountHeight, IsNotThatOverTheGroundOutdoors) {
  synthetic::House house = synthetic::one_room(40.0, 40.0);
  house.boxes.push_back({{8.0, 8.0, 0.0}, {32.0, 32.0, 0.5}});
  const double z_m = 1.5;
  std::vector<Scan> scans = {
      synthetic::standing_scan(house, Pose::from_xyz_yaw({20.0, 20.0, z_m}, 0.3), synthetic::WalkConfig())};
  for (Scan& scan : scans)
    for (std::size_t i = 0; i < scan.range_m.size(); ++i)
      if (std::abs(std::atan2(scan.point_L[i].y(), scan.point_L[i].x())) > 0.8 && scan.range_m[i] > 12.2)
        scan.range_m[i] = 0.0;
  const std::optional<double> height = height_over_floor(scans, synthetic::calibration(), 1);
  ASSERT_TRUE(height.has_value());
  EXPECT_NEAR(*height, z_m - 0.5 + synthetic::calibration().X_RL.t.z(), 0.05);
}

TEST(MountHeight, IsUnknownWhereFewScansSeeAFloor) {
  std::vector<Scan> scans = scans_from(0.5, 0.0);
  for (Scan& scan : scans) std::fill(scan.range_m.begin(), scan.range_m.end(), 0.0);
  EXPECT_FALSE(height_over_floor(scans, synthetic::calibration(), 1).has_value());
  EXPECT_FALSE(height_over_floor({}, synthetic::calibration(), 1).has_value());
}

}  // namespace
}  // namespace plumbline::slam
