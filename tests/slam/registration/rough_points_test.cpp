// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/rough_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "bim/random/stream.h"
#include "slam/registration/surfels.h"

namespace plumbline::slam {
namespace {

/// 16 rings, 2 degrees apart, 0.8 m above a floor, and what is seen along a direction beside it: range, else infinity.
DeskewedScan scan_of(const std::function<double(const Eigen::Vector3d& d_R)>& range_m) {
  DeskewedScan scan;
  scan.rings = 16;
  scan.columns = 900;
  for (int column = 0; column < scan.columns; ++column)
    for (int ring = 0; ring < scan.rings; ++ring) {
      const double azimuth = 2.0 * M_PI * column / scan.columns, elevation = (2.0 * ring - 15.0) * M_PI / 180.0;
      const Eigen::Vector3d d_R(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                std::sin(elevation));
      const double floor_m = d_R.z() < 0.0 ? -0.8 / d_R.z() : std::numeric_limits<double>::infinity();
      const double r = std::min(floor_m, range_m(d_R));
      scan.range_m.push_back(r < 60.0 ? r : 0.0);
      scan.point_R.emplace_back(r < 60.0 ? Eigen::Vector3d(r * d_R) : Eigen::Vector3d::Zero());
    }
  return scan;
}

/// To an upright cylinder of this radius about (x, y).
double to_post(const Eigen::Vector3d& d, double x, double y, double radius) {
  const double a = d.head<2>().squaredNorm(), b = d.x() * x + d.y() * y;
  const double root = b * b - a * (x * x + y * y - radius * radius);
  return b > 0.0 && root > 0.0 ? (b - std::sqrt(root)) / a : std::numeric_limits<double>::infinity();
}

SurfelConfig outdoors() {
  SurfelConfig config;
  config.max_range_m = 60.0;
  return config;
}

TEST(RoughPoints, ArePostsThatAreTooThinForSurfels) {
  const DeskewedScan scan = scan_of([](const Eigen::Vector3d& d) { return to_post(d, 15.0, 5.0, 0.15); });
  const std::vector<Eigen::Vector3d> rough_R = find_surfaces(scan, outdoors()).rough_R;
  ASSERT_GE(rough_R.size(), 4U);
  for (const Eigen::Vector3d& p_R : rough_R) EXPECT_LT((p_R.head<2>() - Eigen::Vector2d(15.0, 5.0)).norm(), 0.2);
}

// The rings on a floor and the last columns of a wall at a grazing angle go along with the robot. Where a ring crosses
// the foot of a wall a point or two are left.
TEST(RoughPoints, AreNoneOfAFloorAndHardlyAnyOfACorridor) {
  const Surfaces floor = find_surfaces(
      scan_of([](const Eigen::Vector3d&) { return std::numeric_limits<double>::infinity(); }), outdoors());
  const Surfaces corridor = find_surfaces(
      scan_of([](const Eigen::Vector3d& d) { return 1.2 / std::max(1e-9, std::abs(d.y())); }), outdoors());
  EXPECT_GT(floor.surfels.size(), 1000U);
  EXPECT_TRUE(floor.rough_R.empty());
  EXPECT_GT(corridor.surfels.size(), 1000U);
  EXPECT_LT(100 * corridor.rough_R.size(), corridor.surfels.size());
}

TEST(RoughPoints, OfCloudsWithoutRingsAreThoseInNoPlane) {
  const Stream random(3, "bim.generate");
  DeskewedScan scan;
  scan.rings = 1;
  for (std::uint64_t k = 0; k < 4000; ++k) {
    const bool is_bush = k % 4 == 0;
    const Eigen::Vector3d u(random.uniform(k, 0), random.uniform(k, 1), random.uniform(k, 2));
    scan.point_R.push_back(is_bush ? Eigen::Vector3d(Eigen::Vector3d(6.0, 6.0, 0.0) + u)
                                   : Eigen::Vector3d(2.0 + 2.0 * u.x(), 2.0 * u.y(), -0.8));
    scan.range_m.push_back(scan.point_R.back().norm());
  }
  scan.columns = static_cast<int>(scan.range_m.size());
  const Surfaces found = find_surfaces(scan, {});
  EXPECT_GT(found.surfels.size(), 50U);
  ASSERT_GT(found.rough_R.size(), 50U);
  EXPECT_GT(std::count_if(found.rough_R.begin(), found.rough_R.end(), [](auto& p) { return p.x() > 5.0; }),
            static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(found.rough_R.size())));
}

TEST(RoughPoints, AreMatchedWithTheNearestOfTheLatestKeyframes) {
  RoughMap map;
  EXPECT_TRUE(map.match(std::vector<Eigen::Vector3d>{{1.0, 0.0, 0.0}}, Pose{}, 1.0).empty());
  map.add({{1.0, 0.0, 0.0}}, Pose{}, 2);
  map.add({{1.0, 0.0, 0.0}}, Pose::from_xyz_yaw({1.0, 0.0, 0.0}, 0.0), 2);
  map.add({{4.0, 0.0, 0.0}}, Pose{}, 2);
  const std::vector<Eigen::Vector3d> points_R = {{1.1, 0.0, 0.0}, {2.1, 0.0, 0.0}, {3.9, 0.0, 0.0}};
  const std::vector<RoughMatch> matches = map.match(points_R, Pose{}, 0.5);
  ASSERT_EQ(matches.size(), 2U) << "the first keyframe is gone";
  EXPECT_EQ(matches[0].p_M.x(), 2.0);
  EXPECT_EQ(matches[1].p_M.x(), 4.0);
}

TEST(RoughPoints, GradientIsThatOfTheCost) {
  const Stream random(5, "bim.generate");
  constexpr double sigma_m = 0.2, h = 1e-6;
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    std::vector<RoughMatch> matches;
    for (std::uint64_t k = 0; k < 30; ++k) {
      const auto u = [&](std::uint32_t lane) { return random.uniform(100 * trial + k, lane); };
      matches.push_back({{8.0 * u(0), 8.0 * u(1), u(2)}, {8.0 * u(0) + 0.3 * u(3), 8.0 * u(1) + 0.3 * u(4), u(2)}});
    }
    const Pose X_MR = Pose::from_xyz_yaw({0.1, -0.1, 0.05}, 0.02);
    const auto cost = [&](const Pose& X) {
      double sum = 0.0;
      for (const RoughMatch& m : matches)
        sum += 0.5 * std::log(1.0 + (X * m.p_R - m.p_M).squaredNorm() / (sigma_m * sigma_m));
      return sum;
    };
    const Normal6 normal = linearize(matches, X_MR, sigma_m);
    for (int k = 0; k < 6; ++k) {
      const Vector6d step = h * Vector6d::Unit(k);
      const double slope = (cost(X_MR * exp_se3(step)) - cost(X_MR * exp_se3(-step))) / (2.0 * h);
      EXPECT_NEAR(normal.g(k), slope, 1e-5 * (1.0 + std::abs(slope)));
    }
  }
}

}  // namespace
}  // namespace plumbline::slam
