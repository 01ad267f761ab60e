// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/free_space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "bim/random/stream.h"
#include "slam/rooms/room_detector.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

TEST(FreeSpace, IslandsAreWhatAFloodFillSaysOnRandomGrids) {
  const Stream stream(2, "bim.generate");
  constexpr int nx = 41, ny = 29, most = 4;
  for (std::uint64_t trial = 0; trial < 40; ++trial) {
    FreeGrid grid{{{0.0, 0.0}, 0.1, nx, ny}, {}};
    grid.free.resize(grid.frame.size());
    for (std::size_t k = 0; k < grid.free.size(); ++k)
      grid.free[k] = stream.uniform(trial, static_cast<std::uint32_t>(k)) < 0.55 + 0.01 * static_cast<double>(trial);
    FreeGrid expected = grid;
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) {
        std::vector<std::array<int, 2>> part = {{x, y}};
        std::vector<bool> seen(grid.free.size(), false);
        std::array<int, 4> box = {x, x, y, y};
        for (std::size_t k = 0; k < part.size(); ++k) {
          const auto [i, j] = part[k];
          if (i < 0 || j < 0 || i >= nx || j >= ny || grid.free[grid.frame.index(i, j)] != 0) continue;
          if (seen[grid.frame.index(i, j)]) continue;
          seen[grid.frame.index(i, j)] = true;
          box = {std::min(box[0], i), std::max(box[1], i), std::min(box[2], j), std::max(box[3], j)};
          for (const auto& n : {std::array{i - 1, j}, {i + 1, j}, {i, j - 1}, {i, j + 1}}) part.push_back(n);
        }
        const bool inside = box[0] > 0 && box[1] < nx - 1 && box[2] > 0 && box[3] < ny - 1;
        if (inside && box[1] - box[0] < most && box[3] - box[2] < most) expected.free[grid.frame.index(x, y)] = 1;
      }
    EXPECT_EQ(without_islands(grid, {.island_m = 0.1 * most}).free, expected.free) << trial;
  }
}

// A pose far off must not ask for all the memory there is.
TEST(FreeSpace, TheGridKeepsToItsMostCells) {
  FreeRays rays;
  rays.end_R = {{3.0, 0.0, 1.0}, {0.0, 3.0, 1.0}, {-3.0, 0.0, 1.0}};
  rays.hit = {false, false, false};
  FreeSpaceMap map{FreeSpaceConfig{}};
  map.carve(rays, Pose{});
  const FreeGrid before = map.seen_free();
  for (const double x : {1e4, 1e12}) map.carve(rays, Pose::from_xyz_yaw({x, x, 0.0}, 0.0));
  EXPECT_EQ(map.seen_free().free, before.free);
  map.carve(rays, Pose::from_xyz_yaw({100.0, 0.0, 0.0}, 0.0));
  EXPECT_GT(map.seen_free().free.size(), before.free.size());
}

// A window over a sill: beams pass, and come back from a mirror image far behind; the wall below is hit.
TEST(FreeSpace, EndsAtAWallThatLightPassesOver) {
  FreeSpaceMap with_wall{FreeSpaceConfig{}}, without{FreeSpaceConfig{}};
  FreeRays rays;
  for (int k = -30; k <= 30; ++k) {
    rays.end_R.emplace_back(8.0, 0.1 * k, 0.0);
    rays.hit.push_back(true);
  }
  for (int look = 0; look < 3; ++look) without.carve(rays, Pose{});
  for (double y = -2.0; y < 2.0; y += 0.05) rays.wall_R.emplace_back(4.0, y, 0.0);
  for (int look = 0; look < 3; ++look) with_wall.carve(rays, Pose{});
  const auto parts = [](const FreeSpaceMap& map) {
    const FreeGrid grid = map.grid();
    const auto at = [&](double x, double y) { return grid.free[grid.frame.find({x, y}).value()] != 0; };
    return std::array{at(2.0, 0.05), at(4.05, 0.05), at(6.0, 0.05)};
  };
  EXPECT_EQ(parts(without), (std::array{true, true, true}));
  EXPECT_EQ(parts(with_wall), (std::array{true, false, true}));
}

TEST(FreeSpace, WallsAreHitWhereAScanSawThemHighEnough) {
  const synthetic::House room = synthetic::one_room();
  MotionBuffer still;
  still.add(Odometry{});
  const Scan message = synthetic::standing_scan(room, Pose::from_xyz_yaw({3.0, 2.0, 0.46}, 0.0), {});
  const DeskewedScan scan = deskew(message, still, synthetic::calibration());
  const std::vector<PlaneObservation> planes = detect_planes(scan, {});
  FreeSpaceConfig config;
  config.wall_top_m = 0.9;
  const std::vector<Eigen::Vector3d> points = wall_points(scan, planes, config);
  EXPECT_GT(points.size(), 300U);  // 20 m of wall, one point a 5 cm
  for (const Eigen::Vector3d& p : points) {
    const double to_wall = std::min(3.0 - std::abs(p.x()), 2.0 - std::abs(p.y()));
    EXPECT_NEAR(to_wall, 0.0, 0.05);
  }
  config.wall_top_m = 3.0;
  EXPECT_TRUE(wall_points(scan, planes, config).empty());
}

}  // namespace
}  // namespace plumbline::slam
