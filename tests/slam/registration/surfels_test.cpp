// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/surfels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "slam/registration/vgicp.h"
#include "tests/slam/graph/random_values.h"

namespace plumbline::slam {
namespace {

/// Half a turn of 32 rings, 1 degree apart, before a wall across x, with range noise.
DeskewedScan scan_of_wall(double distance_m, double noise_m, RandomValues& random) {
  constexpr double deg = std::numbers::pi / 180.0;
  DeskewedScan scan;
  scan.rings = 32;
  scan.columns = 1024;
  for (int column = 0; column < scan.columns; ++column)
    for (int ring = 0; ring < scan.rings; ++ring) {
      const double azimuth = 2.0 * std::numbers::pi * column / scan.columns - std::numbers::pi;
      const double elevation = deg * (ring - 15.5);
      const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                std::sin(elevation));
      const bool meets = ray.x() > 0.4;
      const double range_m = meets ? distance_m / ray.x() + noise_m * random.gauss() : 0.0;
      scan.range_m.push_back(range_m);
      scan.point_R.emplace_back(range_m * ray);
    }
  return scan;
}

// Near by, the next ring is no farther than range noise: normals of three such rings would be noise.
TEST(RingSurfels, KnowTheNormalOfANoisyWallNearBy) {
  for (std::uint64_t trial = 0; trial < 6; ++trial) {
    RandomValues random(73, trial);
    const std::vector<Surfel> surfels = make_surfels(scan_of_wall(random.uniform(0.8, 2.0), 0.02, random), {});
    ASSERT_GT(surfels.size(), 40U);
    const double good = 0.95;  // 18 degrees
    const auto across =
        std::count_if(surfels.begin(), surfels.end(), [&](const Surfel& s) { return std::abs(s.normal_R.x()) > good; });
    EXPECT_GT(static_cast<double>(across), 0.9 * static_cast<double>(surfels.size()));
  }
}

// Whatever their distance, as few returns as these may be all that tells the way.
TEST(RingSurfels, ReachAsFarAsReturnsDo) {
  RandomValues random(74, 0);
  const std::vector<Surfel> surfels = make_surfels(scan_of_wall(60.0, 0.01, random), {});
  EXPECT_GT(surfels.size(), 500U);
}

/// Points 0.2 m apart on all sides of a hall, seen from its middle, without rings.
DeskewedScan scan_of_hall(const Eigen::Vector3d& size, const Eigen::Vector3d& from, RandomValues& random) {
  constexpr double spacing_m = 0.2, noise_m = 0.01;
  DeskewedScan scan;
  scan.rings = 1;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-0.5, 0.5}) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (double a = -0.5 * size(u); a < 0.5 * size(u); a += spacing_m)
        for (double b = -0.5 * size(v); b < 0.5 * size(v); b += spacing_m) {
          Eigen::Vector3d p = Eigen::Vector3d::Zero();
          p(axis) = side * size(axis) + noise_m * random.gauss();
          p(u) = a;
          p(v) = b;
          scan.point_R.emplace_back(p - from);
          scan.range_m.push_back(scan.point_R.back().norm());
        }
    }
  scan.columns = static_cast<int>(scan.range_m.size());
  return scan;
}

// The time that a scan takes is bounded, however many surfels it has.
TEST(VgicpOdometry, RegistersAShareOfVeryManySurfels) {
  constexpr double most_registered = 5000.0;
  RandomValues random(74, 0);
  const Eigen::Vector3d size(40.0, 30.0, 10.0), moved(0.15, 0.05, 0.0);
  const VgicpConfig config;
  VgicpOdometry odometry(config);
  (void)odometry.match(scan_of_hall(size, Eigen::Vector3d::Zero(), random), {});
  odometry.commit({}, true);
  const DeskewedScan next = scan_of_hall(size, moved, random);
  OdometrySample none;
  none.valid = false;
  const Registration found = odometry.match(next, none);
  EXPECT_LT((found.X_MR.t - moved).norm(), 0.01);
  const double most_of_one = 1.0 / (2.0 * config.registration.sigma_normal_m * config.registration.sigma_normal_m);
  EXPECT_LT(found.information.diagonal().head<3>().sum(), 1.1 * most_registered * most_of_one);
}

// Where a scan fits little, other starts are tried. One that leads farther than a robot comes meanwhile leads to a
// place that is alike, such as the room below.
TEST(VgicpOdometry, TakesNoStartThatLeadsFartherThanARobotComes) {
  RandomValues random(75, 0);
  const Eigen::Vector3d size(12.0, 9.0, 3.0);
  const double turn_rad = 0.7;
  DeskewedScan turned = scan_of_hall(size, Eigen::Vector3d::Zero(), random);
  for (Eigen::Vector3d& point_R : turned.point_R) point_R = exp_so3({0.0, 0.0, -turn_rad}) * point_R;
  for (const double farthest_rad : {turn_rad + 0.1, turn_rad - 0.1}) {
    VgicpOdometry odometry{VgicpConfig{}};
    (void)odometry.match(scan_of_hall(size, Eigen::Vector3d::Zero(), random), {});
    odometry.commit({}, true);
    OdometrySample none;
    none.valid = false;
    none.farthest_rad = farthest_rad;
    const Registration found = odometry.match(turned, none, 1.0);
    const bool is_found = std::abs(log_so3(found.X_MR.q).z() - turn_rad) < 0.01;
    EXPECT_EQ(is_found, farthest_rad > turn_rad) << log_so3(found.X_MR.q).z();
    EXPECT_EQ(found.from_expected, farthest_rad < turn_rad);
  }
}

}  // namespace
}  // namespace plumbline::slam
