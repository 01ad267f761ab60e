// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/wall_tolerance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "bim/random/stream.h"
#include "slam/localization/tracker.h"

namespace plumbline::slam {
namespace {

/// Walls around a robot that stands off by `off` (x, y, yaw, range bias), which stand off the plan so far.
std::vector<SeenWall> random_walls(const Eigen::Vector4d& off, const WallTolerance& tolerance, std::uint64_t tick,
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
    const double noise_m = 0.002 + 0.03 * std::pow(stream.uniform(tick, lane, 3), 2);
    wall.information = 1.0 / (noise_m * noise_m);
    wall.length = 1.0 + 3.0 * stream.uniform(tick, lane, 4);
    const double sigma = std::sqrt(std::pow(tolerance.offset_m, 2) + tolerance.noise * noise_m * noise_m);
    wall.residual_m = wall.J.dot(off) + sigma * stream.gauss(tick, lane, 10);
    const double turn_sigma = std::sqrt(12.0 * tolerance.direction) * config.wall_tolerance_m / wall.length;
    wall.turn_rad = off[2] + turn_sigma * stream.gauss(tick, lane, 20);
    walls.push_back(wall);
  }
  return walls;
}

/// Probability of each share of the noise.
std::array<double, WallTolerances::noises> noise_probabilities(const WallTolerances& tolerances) {
  std::array<double, WallTolerances::noises> sums{};
  const auto p = tolerances.probabilities();
  for (std::size_t i = 0; i < p.size(); ++i) sums[i / WallTolerances::offsets] += p[i];
  return sums;
}

// Restricted maximum likelihood: fitting the pose takes nothing away. Offsets, noise and directions are told apart.
TEST(WallTolerances, AreThoseThatResidualsHave) {
  TrackerConfig config;
  config.wall_forgetting = 0.01;
  config.wall_angle_min = 1e-6;
  for (const WallTolerance truly : {WallTolerance{0.003, 1.0, 0.15},
                                    {0.008, 1.0, 1.0},
                                    {0.02, 1.0, 6.0},
                                    {0.008, 0.25, 0.1},
                                    {0.004, 0.0625, 2.0}}) {
    WallTolerances measured(config);
    for (std::uint64_t tick = 0; tick < 3000; ++tick)
      measured.add(random_walls({0.02, -0.01, 0.003, 0.0}, truly, tick, config), {0.0, 0.01 * 0.01, 0.0}, config);
    // Half of the way to the next tolerance compared, by its root.
    EXPECT_NEAR(std::log(measured.mean().offset_m / truly.offset_m), 0.0, 0.5 * std::log(1.5));
    EXPECT_NEAR(measured.mean().direction, truly.direction, 0.25 * truly.direction);
    const auto noise = noise_probabilities(measured);
    const auto of_truth = static_cast<std::size_t>(std::lround(std::log(truly.noise) / std::log(0.25)));
    EXPECT_EQ(std::max_element(noise.begin(), noise.end()) - noise.begin(), static_cast<std::ptrdiff_t>(of_truth));
  }
}

TEST(WallTolerances, AreNotMovedByThePose) {
  const TrackerConfig config;
  WallTolerances right(config), shifted(config);
  for (std::uint64_t tick = 0; tick < 50; ++tick) {
    const WallTolerance truly{0.008, 1.0, 1.0};
    right.add(random_walls(Eigen::Vector4d::Zero(), truly, tick, config), {}, config);
    shifted.add(random_walls({0.1, -0.08, 0.05, 0.0}, truly, tick, config), {}, config);
    EXPECT_NEAR(right.mean().offset_m, shifted.mean().offset_m, 0.02 * right.mean().offset_m);
    EXPECT_NEAR(right.mean().direction, shifted.mean().direction, 0.02 * right.mean().direction);
  }
}

// With no more walls than fix a pose nothing is learnt; what was expected stays.
TEST(WallTolerances, AsManyWallsAsFixAPoseTellNothing) {
  const TrackerConfig config;
  WallTolerances tolerances(config);
  const double expected = tolerances.mean().offset_m;
  EXPECT_NEAR(expected, 0.024, 0.001);  // of the prior, whose tail ends with the tolerances compared
  std::vector<SeenWall> walls(2);
  walls[0] = {{1.0, 0.0, 0.0, 1.0}, 0.09, 1e6, 3.0, 1.0, 0.0};
  walls[1] = {{0.0, 1.0, 0.0, 1.0}, -0.07, 1e6, 3.0, 1.0, 0.0};
  for (int i = 0; i < 200; ++i) tolerances.add(walls, {}, config);
  EXPECT_NEAR(tolerances.mean().offset_m, expected, 0.01 * expected);
  for (int i = 0; i < 200; ++i) tolerances.add({}, {}, config);
  EXPECT_NEAR(tolerances.mean().offset_m, expected, 0.01 * expected);
}

TEST(WallTolerances, TheLeastHolds) {
  const TrackerConfig config;
  WallTolerances tolerances(config);
  for (std::uint64_t tick = 0; tick < 500; ++tick)
    tolerances.add(random_walls(Eigen::Vector4d::Zero(), {1e-5, 1e-6, 1e-6}, tick, config), {}, config);
  EXPECT_EQ(tolerances.tolerance(0).offset_m, config.wall_tolerance_min_m);
  EXPECT_GE(tolerances.mean().offset_m, config.wall_tolerance_min_m);
  EXPECT_LT(tolerances.mean().offset_m, 1.5 * config.wall_tolerance_min_m);
}

TEST(WallTolerances, ProbabilitiesSumToOneHoweverUnlikelyAllAre) {
  const TrackerConfig config;
  WallTolerances tolerances(config);
  for (std::uint64_t tick = 0; tick < 100; ++tick) {
    tolerances.add(random_walls(Eigen::Vector4d::Zero(), {5.0, 1.0, 1e4}, tick, config), {}, config);
    const auto p = tolerances.probabilities();
    EXPECT_NEAR(std::accumulate(p.begin(), p.end(), 0.0), 1.0, 1e-12);
  }
  EXPECT_GT(tolerances.mean().offset_m, 0.07);
}

// What the walls of some windows tell of a building makes the covariance of the next pose honest, whether its walls
// stand as planned or far off.
TEST(WallTolerances, MakeCovariancesHonest) {
  const TrackerConfig config;
  const int worlds = 300, windows = 40;
  for (const double offset_m : {0.003, 0.008, 0.015, 0.025}) {
    const WallTolerance truly{offset_m, 1.0, 1.0};
    double nees = 0.0;
    for (int world = 0; world < worlds; ++world) {
      WallTolerances tolerances(config);
      const BiasPrior bias{0.0, 0.01 * 0.01, 0.0};
      std::uint64_t tick = 1000 * static_cast<std::uint64_t>(world);
      for (int i = 0; i < windows; ++i)
        tolerances.add(random_walls(Eigen::Vector4d::Zero(), truly, tick++, config), bias, config);
      const std::vector<SeenWall> walls = random_walls(Eigen::Vector4d::Zero(), truly, tick, config);
      Eigen::Matrix4d known = Eigen::Matrix4d::Identity();
      known(3, 3) = 1.0 / bias.variance;
      Eigen::Vector4d pull = Eigen::Vector4d::Zero();
      const WallTolerance mean = tolerances.mean();
      for (const SeenWall& wall : walls) {
        pull += wall.J * wall.residual_m / (std::pow(mean.offset_m, 2) + 1.0 / wall.information);
        pull[2] += wall.turn_rad / (12.0 * mean.direction * std::pow(config.wall_tolerance_m / wall.length, 2));
      }
      const Eigen::Vector4d error = (known + wall_information(walls, mean, config)).ldlt().solve(pull);
      Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
      const auto p = tolerances.probabilities();
      for (int i = 0; i < WallTolerances::count; ++i)
        covariance +=
            p[static_cast<std::size_t>(i)] *
            (known + wall_information(walls, tolerances.tolerance(i), config)).inverse().topLeftCorner<2, 2>();
      nees += error.head<2>().dot(covariance.ldlt().solve(error.head<2>())) / (2.0 * worlds);
    }
    // Walls that stand better than the prior of 8 mm says leave it too wide, for so few.
    EXPECT_GT(nees, 0.5) << offset_m;
    EXPECT_LT(nees, 1.35) << offset_m;
  }
}

TEST(WallInformation, ScalesWithTheVariancesButForTheLeastAngle) {
  TrackerConfig config;
  config.wall_angle_min = 0.0;
  for (std::uint64_t tick = 0; tick < 20; ++tick) {
    const std::vector<SeenWall> walls = random_walls(Eigen::Vector4d::Zero(), {0.008, 1.0, 1.0}, tick, config);
    const Eigen::Matrix4d once = wall_information(walls, {0.008, 1.0, 1.0}, config),
                          scaled = wall_information(walls, {0.016, 4.0, 4.0}, config);
    EXPECT_LT((once - 4.0 * scaled).norm(), 1e-9 * once.norm());
  }
}

// Straight walls that stand off the plan leave the yaw well known; crooked ones do not.
TEST(WallInformation, TellsTheYawByDirectionsAndThePositionByOffsets) {
  TrackerConfig config;
  const std::vector<SeenWall> walls = random_walls(Eigen::Vector4d::Zero(), {0.008, 1.0, 1.0}, 3, config);
  const Eigen::Matrix4d once = wall_information(walls, {0.008, 1.0, 1.0}, config);
  const Eigen::Matrix4d straight = wall_information(walls, {0.008, 1.0, 0.1}, config);
  EXPECT_EQ(once(0, 0), straight(0, 0));
  EXPECT_EQ(once(1, 1), straight(1, 1));
  EXPECT_GT(straight(2, 2), 2.0 * once(2, 2));
}

}  // namespace
}  // namespace plumbline::slam
