// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/wall_variance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bim/random/stream.h"
#include "slam/localization/tracker.h"

namespace plumbline::slam {
namespace {

/// Walls around a robot that stands off by `off` (x, y, yaw, range bias); their residuals have so many times the
/// variances that are expected of them.
std::vector<SeenWall> random_walls(const Eigen::Vector4d& off, const WallVariances& variances, std::uint64_t tick,
                                   const TrackerConfig& config) {
  const Stream stream(5, "slam.localize.init");
  std::vector<SeenWall> walls;
  const int count = 4 + static_cast<int>(8.0 * stream.uniform(tick, 99, 0));
  for (int i = 0; i < count; ++i) {
    const auto lane = static_cast<std::uint32_t>(i);
    const double azimuth = 0.5 * std::numbers::pi * std::floor(4.0 * stream.uniform(tick, lane, 0));
    const double along = 4.0 * stream.uniform(tick, lane, 1) - 2.0;
    SeenWall wall;
    wall.J = {std::cos(azimuth), std::sin(azimuth), along, 0.8 + 0.2 * stream.uniform(tick, lane, 2)};
    const double noise_m = 0.002 + 0.01 * stream.uniform(tick, lane, 3);
    wall.information = 1.0 / (noise_m * noise_m);
    wall.length = 1.0 + 3.0 * stream.uniform(tick, lane, 4);
    const double sigma =
        std::sqrt(variances.offset * (config.wall_tolerance_m * config.wall_tolerance_m + noise_m * noise_m));
    wall.residual_m = wall.J.dot(off) + sigma * stream.gauss(tick, lane, 10);
    const double turn_sigma = std::sqrt(12.0 * variances.direction) * config.wall_tolerance_m / wall.length;
    wall.turn_rad = off[2] + turn_sigma * stream.gauss(tick, lane, 20);
    walls.push_back(wall);
  }
  return walls;
}

// Restricted maximum likelihood: fitting the pose takes nothing away. Offsets and directions are told apart.
TEST(WallVarianceFactor, IsTheOneThatResidualsHave) {
  TrackerConfig config;
  config.wall_forgetting = 0.01;
  config.wall_angle_min = 1e-6;
  for (const WallVariances truly : {WallVariances{0.15, 0.15}, {1.0, 1.0}, {6.0, 6.0}, {1.0, 0.1}, {0.2, 2.0}}) {
    WallVarianceFactor measured;
    for (std::uint64_t tick = 0; tick < 3000; ++tick)
      measured.add(random_walls({0.02, -0.01, 0.003, 0.0}, truly, tick, config), {0.0, 0.01 * 0.01, 0.0}, config);
    // Weights are by the variances expected, not by those there are: the worse half of the walls is fitted, too.
    EXPECT_NEAR(measured.value().offset, truly.offset, 0.2 * truly.offset + 0.02 * truly.direction);
    EXPECT_NEAR(measured.value().direction, truly.direction, 0.2 * truly.direction + 0.02 * truly.offset);
  }
}

TEST(WallVarianceFactor, IsNotMovedByThePose) {
  const TrackerConfig config;
  WallVarianceFactor right, shifted;
  for (std::uint64_t tick = 0; tick < 50; ++tick) {
    right.add(random_walls(Eigen::Vector4d::Zero(), {}, tick, config), {}, config);
    shifted.add(random_walls({0.1, -0.08, 0.05, 0.0}, {}, tick, config), {}, config);
    EXPECT_NEAR(right.value().offset, shifted.value().offset, 0.02 * right.value().offset);
    EXPECT_NEAR(right.value().direction, shifted.value().direction, 0.02 * right.value().direction);
  }
}

// With no more walls than fix a pose nothing is learnt; what was expected stays.
TEST(WallVarianceFactor, AsManyWallsAsFixAPoseTellNothing) {
  const TrackerConfig config;
  WallVarianceFactor factor;
  std::vector<SeenWall> walls(2);
  walls[0] = {{1.0, 0.0, 0.0, 1.0}, 0.09, 1e6, 3.0, 1.0, 0.0};
  walls[1] = {{0.0, 1.0, 0.0, 1.0}, -0.07, 1e6, 3.0, 1.0, 0.0};
  for (int i = 0; i < 200; ++i) factor.add(walls, {}, config);
  EXPECT_NEAR(factor.value().offset, 1.0, 0.01);
  for (int i = 0; i < 200; ++i) factor.add({}, {}, config);
  EXPECT_NEAR(factor.value().offset, 1.0, 0.01);
}

TEST(WallVarianceFactor, TheLeastToleranceHolds) {
  TrackerConfig config;
  config.wall_tolerance_weight = 0.1;
  WallVarianceFactor factor;
  for (std::uint64_t tick = 0; tick < 500; ++tick)
    factor.add(random_walls(Eigen::Vector4d::Zero(), {1e-6, 1e-6}, tick, config), {}, config);
  EXPECT_DOUBLE_EQ(factor.value().offset, std::pow(config.wall_tolerance_min_m / config.wall_tolerance_m, 2));
}

TEST(WallInformation, ScalesWithTheFactorButForTheLeastAngle) {
  TrackerConfig config;
  config.wall_angle_min = 0.0;
  for (std::uint64_t tick = 0; tick < 20; ++tick) {
    const std::vector<SeenWall> walls = random_walls(Eigen::Vector4d::Zero(), {}, tick, config);
    const Eigen::Matrix4d once = wall_information(walls, {}, config),
                          scaled = wall_information(walls, {4.0, 4.0}, config);
    EXPECT_LT((once - 4.0 * scaled).norm(), 1e-9 * once.norm());
  }
}

// Straight walls that stand off the plan leave the yaw well known; crooked ones do not.
TEST(WallInformation, TellsTheYawByDirectionsAndThePositionByOffsets) {
  TrackerConfig config;
  const std::vector<SeenWall> walls = random_walls(Eigen::Vector4d::Zero(), {}, 3, config);
  const Eigen::Matrix4d once = wall_information(walls, {}, config);
  const Eigen::Matrix4d straight = wall_information(walls, {1.0, 0.1}, config);
  EXPECT_EQ(once(0, 0), straight(0, 0));
  EXPECT_EQ(once(1, 1), straight(1, 1));
  EXPECT_GT(straight(2, 2), 2.0 * once(2, 2));
}

}  // namespace
}  // namespace plumbline::slam
