// SPDX-License-Identifier: Apache-2.0
#include "slam/mapping/laser_range_calibration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/slam/graph/random_values.h"

namespace plumbline::slam {
namespace {

constexpr int lasers = 8;
const Eigen::Vector3d sensor_R(0.0, 0.0, 0.2);

/// A room of 8 x 5 m that was walked through by a sensor whose lasers have offsets of their own.
struct Walk {
  std::vector<PlaneNode> walls;
  std::vector<double> offset_m;
  std::vector<CloudKeyframe> clouds;

  explicit Walk(std::uint64_t trial) {
    RandomValues random(61, trial);
    const double unit_m = 0.02 * random.gauss();
    for (int k = 0; k < lasers; ++k) offset_m.push_back(unit_m + 0.013 * random.gauss());
    // Walls were found from the same ranges: they stand off by about what these have in common.
    add_wall({1, 0}, {0, 0}, {0, 5}, unit_m);
    add_wall({-1, 0}, {8, 0}, {8, 5}, unit_m);
    add_wall({0, 1}, {0, 0}, {8, 0}, unit_m);
    add_wall({0, -1}, {0, 5}, {8, 5}, unit_m);
    for (int k = 0; k < 10; ++k)
      look(Pose::from_xyz_yaw({1.0 + 0.6 * k, random.uniform(1, 4), 0.5}, random.uniform(-3.0, 3.0)), random);
  }

  void add_wall(const Eigen::Vector2d& n, const Eigen::Vector2d& a, const Eigen::Vector2d& b, double back_m) {
    walls.push_back({static_cast<int>(walls.size()), Plane{{n.x(), n.y(), 0.0}, back_m - n.dot(a)}, a - back_m * n,
                     b - back_m * n, 0.0, 2.4, 9});
  }

  void look(const Pose& X_FR, RandomValues& random) {
    CloudKeyframe cloud{X_FR, {}, {}};
    const Eigen::Vector3d origin = X_FR * sensor_R;
    for (int laser = 0; laser < lasers; ++laser)
      for (int k = 0; k < 180; ++k) {
        const double yaw = std::numbers::pi * (k + 0.5) / 90.0, elevation = 0.05 * (laser - 3.5);
        const Eigen::Vector3d ray(std::cos(elevation) * std::cos(yaw), std::cos(elevation) * std::sin(yaw),
                                  std::sin(elevation));
        const double to_x = ((ray.x() > 0.0 ? 8.0 : 0.0) - origin.x()) / ray.x();
        const double to_y = ((ray.y() > 0.0 ? 5.0 : 0.0) - origin.y()) / ray.y();
        const double range = std::min(to_x, to_y) + offset_m[static_cast<std::size_t>(laser)] + 0.01 * random.gauss();
        cloud.points_R.push_back((X_FR.inverse() * (origin + range * ray)).cast<float>());
        cloud.lasers.push_back(static_cast<std::uint8_t>(laser));
      }
    clouds.push_back(std::move(cloud));
  }

  /// Root mean square distance of the returns from the room's walls, m.
  [[nodiscard]] double thickness() const {
    double sum = 0.0;
    std::size_t count = 0;
    for (const CloudKeyframe& cloud : clouds)
      for (const Eigen::Vector3f& p_R : cloud.points_R) {
        const Eigen::Vector3d p = cloud.X_FR * p_R.cast<double>();
        const double d = std::min(std::min(std::abs(p.x()), std::abs(p.x() - 8.0)),
                                  std::min(std::abs(p.y()), std::abs(p.y() - 5.0)));
        sum += d * d;
        ++count;
      }
    return std::sqrt(sum / static_cast<double>(count));
  }
};

// 14,400 returns of 1 cm: 2.5 mm is four standard deviations of what all lasers have in common.
TEST(LaserRangeCalibration, AreFoundByHowWallsMoveWithTheAngleTheyAreMetAt) {
  for (std::uint64_t trial = 0; trial < 10; ++trial) {
    Walk walk(trial);
    const std::vector<double> found = calibrate_laser_ranges(walk.clouds, walk.walls, sensor_R, {.inflation = 1.0}, {});
    ASSERT_EQ(found.size(), walk.offset_m.size());
    for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], walk.offset_m[k], 0.0025) << trial;
    correct_ranges(walk.clouds, found, sensor_R);
    EXPECT_LT(walk.thickness(), 0.0105) << trial;
  }
}

TEST(LaserRangeCalibration, IsZeroWhereWallsConstrainNothing) {
  Walk walk(1);
  // One laser that hit one wall at one angle: the wall may as well stand elsewhere.
  CloudKeyframe cloud{Pose::from_xyz_yaw({4, 2.5, 0.5}, 0.0), {}, {}};
  for (int k = 0; k < 1000; ++k) {
    cloud.points_R.emplace_back(0.0F, 2.55F, 0.2F);
    cloud.lasers.push_back(0);
  }
  const std::vector<CloudKeyframe> one = {cloud};
  const std::vector<double> found = calibrate_laser_ranges(one, walk.walls, sensor_R, {.inflation = 1.0}, {});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0], 0.0, 1e-6);
}

// A pane 0.2 m behind its wall's face: part of that wall, as for mirror images, unless the config says that it stands
// nearer.
TEST(LaserRangeCalibration, TakeTheSameWallsForOneAsMirrorImagesDo) {
  const std::vector<PlaneNode> walls = {{0, Plane{{0, -1, 0}, 5.0}, {0, 5}, {8, 5}, 0.0, 2.4, 9},
                                        {1, Plane{{0, -1, 0}, 5.2}, {3.5, 5.2}, {4.5, 5.2}, 0.0, 2.4, 3}};
  CloudKeyframe cloud{Pose::from_xyz_yaw({4, 2.5, 0.5}, 0.0), {}, {}};
  for (int k = 0; k < 1000; ++k) {
    cloud.points_R.emplace_back(0.0F, 2.7F, 0.2F);
    cloud.lasers.push_back(0);
  }
  const std::vector<CloudKeyframe> one = {cloud};
  EXPECT_TRUE(calibrate_laser_ranges(one, walls, sensor_R, {}, {}).empty());
  EXPECT_EQ(calibrate_laser_ranges(one, walls, sensor_R, {}, {.pane_depth_m = 0.1}).size(), 1U);
}

TEST(LaserRangeCalibration, NeedWallsAndLasers) {
  Walk walk(2);
  EXPECT_TRUE(calibrate_laser_ranges(walk.clouds, {}, sensor_R, {}, {}).empty());
  for (CloudKeyframe& cloud : walk.clouds) cloud.lasers.clear();
  EXPECT_TRUE(calibrate_laser_ranges(walk.clouds, walk.walls, sensor_R, {}, {}).empty());
  const std::vector<Eigen::Vector3f> before = walk.clouds[0].points_R;
  correct_ranges(walk.clouds, std::vector<double>(lasers, 0.1), sensor_R);
  EXPECT_EQ(walk.clouds[0].points_R, before);
}

}  // namespace
}  // namespace plumbline::slam
