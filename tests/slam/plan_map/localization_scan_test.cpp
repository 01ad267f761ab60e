// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/localization_scan.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

bim::PlanRoom room_of_height(double height_m, double area_m2) {
  bim::PlanRoom room;
  room.z0 = 1.0;
  room.z1 = 1.0 + height_m;
  room.polygon = {{0.0, 0.0}, {area_m2, 0.0}, {area_m2, 1.0}, {0.0, 1.0}};
  return room;
}

// In a parking deck of 2.4 m ceilings passed as walls, and right poses were lost.
TEST(WallHeight, StaysBelowLowCeilings) {
  const LocalizationScanConfig config;
  bim::Plan plan;
  EXPECT_EQ(wall_height(plan, config), config.max_height_m);
  plan.rooms = {room_of_height(3.0, 50.0)};
  EXPECT_EQ(wall_height(plan, config), config.max_height_m);
  plan.rooms.push_back(room_of_height(2.0, 5.0));  // below a stair
  EXPECT_EQ(wall_height(plan, config), config.max_height_m);
  plan.rooms.push_back(room_of_height(2.4, 20.0));
  EXPECT_NEAR(wall_height(plan, config), 2.32, 1e-12);
  plan.rooms.push_back(room_of_height(0.4, 500.0));  // below the floor, for pipes
  EXPECT_NEAR(wall_height(plan, config), 2.32, 1e-12);
}

/// What a robot in the middle of a room sees; `rings`: false strips the scan of its order.
LocalizationScan seen_in_a_room(bool rings) {
  Scan scan = synthetic::standing_scan(synthetic::one_room(), Pose::from_xyz_yaw({3.0, 2.0, 0.5}, 0.3), {});
  if (!rings) {
    scan.columns *= scan.rings;
    scan.rings = 1;
  }
  MotionBuffer motion;
  motion.add({0, Pose{}});
  return make_localization_scan(deskew(scan, motion, synthetic::calibration()), {}, Pose{}, synthetic::calibration(),
                                {});
}

int returns_of(const BeamGrid& grid) {
  int returns = 0;
  for (const BeamGridBlock& block : grid.blocks)
    for (int k = 0; k < 4; ++k) returns += block.range[k] > 0.0F ? 1 : 0;
  return returns;
}

/// A turn in a hall: rings at these elevations, in degrees.
LocalizationScan seen_by_rings(const std::vector<double>& elevations_deg) {
  DeskewedScan scan;
  scan.columns = 360;
  scan.rings = static_cast<int>(elevations_deg.size());
  for (int column = 0; column < scan.columns; ++column)
    for (const double elevation_deg : elevations_deg) {
      const double azimuth = column * M_PI / 180.0, elevation = elevation_deg * M_PI / 180.0;
      scan.point_R.emplace_back(4.0 * std::cos(azimuth), 4.0 * std::sin(azimuth), 4.0 * std::tan(elevation));
      scan.range_m.push_back(scan.point_R.back().norm());
    }
  Calibration calibration;
  calibration.sensor_height_m = 1.0;
  return make_localization_scan(scan, {}, Pose{}, calibration, {});
}

/// A level plane so far below R, with its returns, which are spread over these directions of 10 degrees.
struct LevelPlane {
  double down_m = 0.0;
  int points = 0;
  int first = 0, last = 35;
  double range_m = 5.0;
};

/// Height found by such planes, of a LiDAR at R that stands 1 m high.
double height_by(const std::vector<LevelPlane>& below) {
  std::vector<PlaneObservation> planes;
  DeskewedScan scan;
  scan.rings = 1;
  const auto add = [&](double azimuth, double range_m, double z) {
    scan.point_R.emplace_back(range_m * std::cos(azimuth), range_m * std::sin(azimuth), z);
    scan.range_m.push_back(scan.point_R.back().norm());
  };
  for (int k = 0; k < 144; ++k) add((k + 0.5) * std::numbers::pi / 72.0 - std::numbers::pi, 10.0, 0.2);  // walls
  for (const LevelPlane& level : below) {
    PlaneObservation plane;
    plane.plane_R = {Eigen::Vector3d::UnitZ(), level.down_m};
    plane.points = level.points;
    planes.push_back(plane);
    for (int direction = level.first; direction <= level.last; ++direction)
      for (const double off : {0.3, 0.5, 0.7}) {
        add((direction + off) * std::numbers::pi / 18.0 - std::numbers::pi, level.range_m, -level.down_m);
      }
  }
  scan.columns = static_cast<int>(scan.range_m.size());
  Calibration calibration;
  calibration.sensor_height_m = 1.0;
  return make_localization_scan(scan, planes, Pose{}, calibration, {}).sensor_height;
}

TEST(LocalizationScan, ATableIsNoFloorHoweverManyReturnsItHolds) {
  EXPECT_NEAR(height_by({{1.02, 100}}), 1.02, 1e-12);
  EXPECT_NEAR(height_by({{0.6, 500}, {1.02, 100}}), 1.02, 1e-12);
  EXPECT_NEAR(height_by({{0.85, 500, 0, 11, 1.5}, {1.02, 100}}), 1.02, 1e-12) << "a pallet";
  EXPECT_NEAR(height_by({{0.6, 500}}), 1.0, 1e-12) << "the floor is hidden";
  EXPECT_NEAR(height_by({{1.7, 100}}), 1.7, 1e-12) << "carried higher than was said";
  EXPECT_NEAR(height_by({{1.3, 5}, {1.02, 100}}), 1.02, 1e-12) << "a few returns by a mirror";
}

// It was taken for the floor, and the robot to stand as much higher.
TEST(LocalizationScan, TheGroundBehindWindowsIsNoFloor) {
  EXPECT_NEAR(height_by({{1.02, 100, 0, 35}, {1.35, 90, 3, 14, 9.0}}), 1.02, 1e-12);
  EXPECT_NEAR(height_by({{1.35, 90, 3, 9, 9.0}}), 1.0, 1e-12) << "alone";
  EXPECT_NEAR(height_by({{1.35, 90, 0, 30}}), 1.35, 1e-12) << "a platform that the robot stands on";
  EXPECT_NEAR(height_by({{2.4, 90, 3, 9, 3.0}}), 2.4, 1e-12) << "a landing";
}

// Whatever the LiDAR, some beams pass over low furniture.
TEST(LocalizationScan, BeamsGoUpAsFarAsThoseOfSixteenRings) {
  std::vector<double> vlp16, even64, hdl32;
  for (int r = 0; r < 16; ++r) vlp16.push_back(2.0 * r - 15.0);
  for (int r = 0; r < 64; ++r) even64.push_back(45.0 * r / 63.0 - 22.5);
  for (int r = 0; r < 32; ++r) hdl32.push_back(4.0 / 3.0 * r - 30.67);
  const LocalizationScan as_is = seen_by_rings(vlp16);
  for (const auto& rings : {even64, hdl32}) {
    const LocalizationScan seen = seen_by_rings(rings);
    ASSERT_EQ(seen.beams.size(), as_is.beams.size());
    for (std::size_t k = 0; k < seen.beams.size(); ++k)
      EXPECT_NEAR(seen.beams[k].slope, as_is.beams[k].slope, 0.03) << k;
  }
}

TEST(LocalizationScan, AScanWithoutRingsHasAsManyBeams) {
  const LocalizationScan with = seen_in_a_room(true), without = seen_in_a_room(false);
  ASSERT_GT(with.beams.size(), 100U);
  EXPECT_GE(without.beams.size(), with.beams.size() * 9 / 10);
  ASSERT_GT(returns_of(with.beam_grid), 1000);
  EXPECT_GE(returns_of(without.beam_grid), returns_of(with.beam_grid) * 9 / 10);
}

}  // namespace
}  // namespace plumbline::slam
