// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/cell_surfels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/slam/graph/random_values.h"

namespace plumbline::slam {
namespace {

constexpr double width_m = 2.4, height_m = 2.8;

/// What a spinning LiDAR of some rings, 2 degrees apart, sees in an endless corridor along x, without noise, in its own
/// frame. X_WS: in W, whose origin is in a lower corner.
std::vector<Eigen::Vector3f> corridor_scan(const Pose& X_WS, int rings, double first_deg) {
  constexpr int columns = 900;
  constexpr double most_m = 30.0, gap_deg = 2.0, deg = std::numbers::pi / 180.0;
  std::vector<Eigen::Vector3f> points;
  for (int column = 0; column < columns; ++column)
    for (int ring = 0; ring < rings; ++ring) {
      const double azimuth = 2.0 * std::numbers::pi * column / columns;
      const double elevation = deg * (first_deg + gap_deg * ring);
      const Eigen::Vector3d ray_S(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                  std::sin(elevation));
      const Eigen::Vector3d ray_W = X_WS.rotation() * ray_S;
      double range_m = std::numeric_limits<double>::infinity();
      const Eigen::Vector2d far(width_m, height_m);
      for (int axis = 1; axis < 3; ++axis) {
        const double to = ray_W(axis) > 0.0 ? far(axis - 1) : 0.0;
        if (std::abs(ray_W(axis)) > 1e-9) range_m = std::min(range_m, (to - X_WS.t(axis)) / ray_W(axis));
      }
      if (range_m < most_m) points.push_back((range_m * ray_S).cast<float>());
    }
  return points;
}

Pose random_pose(RandomValues& random) {
  const Eigen::Vector3d tilt_and_turn(random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05),
                                      random.uniform(-std::numbers::pi, std::numbers::pi));
  return {exp_so3(tilt_and_turn), {0.0, random.uniform(0.6, width_m - 0.6), random.uniform(0.4, 1.6)}};
}

CellSurfels cells(const std::optional<Eigen::Vector3d>& sensor) {
  return {.size_m = 0.2, .max_thickness_m = 0.05, .sensor = sensor};
}

// A ring is bent where it goes from wall to floor: its plane is that of the laser, and passes for a wall across.
TEST(CellSurfels, OneRingHasNoNormals) {
  for (std::uint64_t trial = 0; trial < 10; ++trial) {
    RandomValues random(72, trial);
    const std::vector<Eigen::Vector3f> ring = corridor_scan(random_pose(random), 1, random.uniform(-15.0, 15.0));
    EXPECT_FALSE(cell_surfels(ring, cells(std::nullopt)).empty());
    EXPECT_TRUE(cell_surfels(ring, cells(Eigen::Vector3d::Zero())).empty());
  }
}

// On the floor rings of 16 are farther apart than voxels of 0.2 m.
TEST(CellSurfels, RingsThatAreFarApartGiveTheFloorByLargerVoxels) {
  const Pose X_WS = Pose::from_xyz_yaw({0.0, 1.2, 0.8}, 0.4);
  const std::vector<Surfel> surfels = cell_surfels(corridor_scan(X_WS, 16, -15.0), cells(Eigen::Vector3d::Zero()));
  const auto on_the_floor = [&](const Surfel& surfel) {
    return std::abs(surfel.mean_R.z() + X_WS.t.z()) < 1e-3 && std::abs(surfel.normal_R.z()) > 0.999;
  };
  EXPECT_GT(std::count_if(surfels.begin(), surfels.end(), on_the_floor), 50);
}

}  // namespace
}  // namespace plumbline::slam
