// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/hdl_slam_paper/floor_detection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bim/geometry/pose.h"
#include "slam/graph/optimize.h"
#include "slam/loop/fitness.h"

namespace plumbline::slam::hdl {
namespace {

constexpr double height_m = 0.46;

/// A level patch of n x n points 5 cm apart at height z.
std::vector<Eigen::Vector3d> patch(int n, double z) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) points.emplace_back(1.0 + 0.05 * i, 0.05 * k - 0.025 * n, z);
  return points;
}

std::vector<Eigen::Vector3d> tilted(double degrees, std::vector<Eigen::Vector3d> points) {
  const Eigen::Quaterniond q = exp_so3({0.0, degrees * std::numbers::pi / 180.0, 0.0});
  for (Eigen::Vector3d& p : points) p = q * p;
  return points;
}

TEST(FloorDetection, FindsTheFloorUnderfoot) {
  const std::optional<Plane> floor = detect_floor(patch(20, -height_m), height_m, {});
  ASSERT_TRUE(floor.has_value());
  EXPECT_NEAR(floor->d, height_m, 1e-6);
  EXPECT_NEAR(floor->n.z(), 1.0, 1e-9);
  EXPECT_TRUE(detect_floor(tilted(8.0, patch(20, -height_m)), height_m, {}).has_value());
}

TEST(FloorDetection, RefusesWhatIsNoFloor) {
  EXPECT_FALSE(detect_floor({}, height_m, {}).has_value());
  EXPECT_FALSE(detect_floor(patch(15, -height_m), height_m, {}).has_value());        // 225 points
  EXPECT_FALSE(detect_floor(patch(20, -height_m + 0.6), height_m, {}).has_value());  // a table
  EXPECT_FALSE(detect_floor(tilted(12.0, patch(20, -height_m)), height_m, {}).has_value());
  std::vector<Eigen::Vector3d> wall;
  for (const Eigen::Vector3d& p : patch(20, 0.0)) wall.emplace_back(2.0, p.y(), -height_m + 0.3 * (p.x() - 1.0));
  EXPECT_FALSE(detect_floor(wall, height_m, {}).has_value());
}

/// Keyframes a metre apart on a level floor, 60 m, that odometry sees pitched by a degree a metre more and more.
double height_off_at_the_end(bool floors) {
  Graph graph;
  PlaneVertex floor;
  floor.plane_M = {Eigen::Vector3d::UnitZ(), height_m};
  floor.fixed = true;
  graph.planes.push_back(floor);
  const Pose step{exp_so3({0.0, std::numbers::pi / 180.0, 0.0}), Eigen::Vector3d::UnitX()};
  const Matrix6d information = fitness_information(0.005, {.sigma_min_rad = 0.1, .sigma_max_rad = 0.4});
  graph.keyframes.push_back({});
  for (int k = 1; k <= 60; ++k) {
    graph.keyframes.push_back({k, graph.keyframes.back().X_MR * step, Pose(), 0});
    graph.pose_factors.push_back({k - 1, k, step, information, false});
    if (floors)
      graph.plane_factors.push_back({k,
                                     0,
                                     {Eigen::Vector3d::UnitZ(), height_m},
                                     FloorDetectionConfig().information * Eigen::Matrix3d::Identity()});
  }
  (void)optimize(graph, 1, {.max_iterations = 50, .relative_decrease = 1e-6, .huber = 1e6});
  EXPECT_EQ(graph.planes[0].plane_M.d, height_m);  // it is fixed
  return std::abs(graph.keyframes.back().X_MR.t.z());
}

// Without floors the way is an arc of 57 m radius: 57.3 (1 - cos 60 deg) = 28.6 m down.
TEST(FloorEdges, HoldTheHeight) {
  EXPECT_NEAR(height_off_at_the_end(false), 28.6, 0.6);
  EXPECT_LT(height_off_at_the_end(true), 1.5);
}

}  // namespace
}  // namespace plumbline::slam::hdl
