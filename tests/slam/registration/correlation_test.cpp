// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/correlation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bim/random/stream.h"

namespace plumbline::slam {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// Points on upright posts, 3 m high, round the origin, 5 to 30 m away.
Points posts(const Stream& random, std::uint64_t trial, int count) {
  Points points;
  for (int post = 0; post < count; ++post) {
    const std::uint64_t draw = 1000 * trial + static_cast<std::uint64_t>(post);
    const double azimuth = random.uniform(draw, 0) * 2.0 * M_PI, range_m = 5.0 + 25.0 * random.uniform(draw, 1);
    for (double z = -0.7; z < 2.3; z += 0.3)
      points.emplace_back(range_m * std::cos(azimuth), range_m * std::sin(azimuth), z);
  }
  return points;
}

Points seen_from(const Points& points_K, const Pose& X_KR) {
  Points points_R;
  for (const Eigen::Vector3d& p_K : points_K) points_R.push_back(X_KR.inverse() * p_K);
  return points_R;
}

Vector6d along(double azimuth) {
  Vector6d direction = Vector6d::Zero();
  direction.head<3>() = Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), 0.0);
  return direction;
}

/// Rings of returns on the ground, 0.8 m below the sensor.
Points ground() {
  Points points;
  for (const double range_m : {3.0, 5.0, 9.0, 20.0})
    for (double azimuth = 0.0; azimuth < 2.0 * M_PI; azimuth += 0.3 / range_m)
      points.emplace_back(range_m * std::cos(azimuth), range_m * std::sin(azimuth), -0.8);
  return points;
}

// Over random fields and motions, in one and in two directions: a place off by less than a step of the search and half
// a voxel.
TEST(Correlation, FindsAMotionThatNothingElseTells) {
  const Stream random(7, "bim.generate");
  constexpr double most_off_m = 0.2 + 0.15;
  int found = 0;
  for (std::uint64_t trial = 0; trial < 60; ++trial) {
    const auto u = [&](std::uint32_t lane) { return random.uniform(trial + 100'000, lane); };
    const double heading = u(0) * 2.0 * M_PI;
    const bool both = trial % 2 == 1;
    const Pose X_KR = Pose::from_xyz_yaw((1.0 + u(1)) * along(heading).head<3>(), 0.5 * (u(2) - 0.5));
    const Points world_K = posts(random, trial, 30);
    const Points scan_R = seen_from(world_K, X_KR);
    // As far as the wanted directions go nothing is known: the search starts at the keyframe.
    const Pose start{X_KR.q, Eigen::Vector3d::Zero()};
    const double heading_R = heading - log_so3(X_KR.q).z();
    std::vector<Vector6d> moves = {along(heading_R)};
    if (both) moves = {along(heading_R + 0.7), along(heading_R + 0.7 + M_PI / 2.0)};
    const std::optional<Pose> result =
        correlate(ReturnVoxels(world_K), scan_R, start, Eigen::Vector3d::Zero(), moves, 2.4);
    if (!result) continue;
    ++found;
    EXPECT_LT((result->t - X_KR.t).norm(), most_off_m) << "trial " << trial;
  }
  EXPECT_GE(found, 50);
}

TEST(Correlation, PeaksWhereASensorWasThatTurnedLittle) {
  const Stream random(7, "bim.generate");
  const std::vector<Vector6d> both = {along(0.0), along(0.5 * M_PI)};
  for (std::uint64_t trial = 0; trial < 10; ++trial) {
    const Points points_K = posts(random, trial, 30);
    const Eigen::Vector3d way_m =
        (1.0 + 0.2 * static_cast<double>(trial)) * along(static_cast<double>(trial)).head<3>();
    const Pose X_KR = Pose::from_xyz_yaw(way_m, 0.01);
    const std::optional<Eigen::Vector3d> peak =
        correlation_peak(ReturnVoxels(points_K), seen_from(points_K, X_KR), Eigen::Vector3d::Zero(), both, 4.0);
    ASSERT_TRUE(peak.has_value()) << "trial " << trial;
    EXPECT_LT((*peak - way_m).norm(), 0.45) << "trial " << trial;
    EXPECT_FALSE(correlation_peak(ReturnVoxels(points_K), points_K, Eigen::Vector3d::Zero(), both, 4.0).has_value())
        << "at rest, trial " << trial;
  }
}

TEST(Correlation, WhatGoesAlongWithTheSensorTellsNothing) {
  const Points rings = ground();
  EXPECT_FALSE(
      correlate(ReturnVoxels(rings), rings, Pose{}, Eigen::Vector3d::Zero(), std::vector<Vector6d>{along(0.0)}, 2.4));
  const Pose turned = Pose::from_xyz_yaw(Eigen::Vector3d::Zero(), 0.4);
  EXPECT_FALSE(correlate(ReturnVoxels(rings), seen_from(rings, turned), turned, Eigen::Vector3d::Zero(),
                         std::vector<Vector6d>{along(0.0), along(M_PI / 2.0)}, 2.4));
}

TEST(Correlation, EqualPlacesAndEmptyScansTellNothing) {
  Points fence;
  for (double x = -20.0; x < 20.0; x += 1.2)
    for (double z = 0.0; z < 1.5; z += 0.3) fence.emplace_back(x, 4.0, z);
  const Pose X_KR = Pose::from_xyz_yaw({1.5, 0.0, 0.0}, 0.0);
  const std::vector<Vector6d> moves = {along(0.0)};
  EXPECT_FALSE(correlate(ReturnVoxels(fence), seen_from(fence, X_KR), Pose{}, Eigen::Vector3d::Zero(), moves, 2.4));
  EXPECT_FALSE(correlate(ReturnVoxels(fence), Points{}, Pose{}, Eigen::Vector3d::Zero(), moves, 2.4));
  EXPECT_FALSE(correlate(ReturnVoxels(), fence, Pose{}, Eigen::Vector3d::Zero(), moves, 2.4));
  EXPECT_FALSE(correlate(ReturnVoxels(fence), fence, Pose{}, Eigen::Vector3d::Zero(), {}, 2.4));
}

// Level or tilted by 30 degrees; then the ground's surfels say which way is up.
TEST(Correlation, PostsStandOnTheGroundAndTheGroundDoesNot) {
  const Stream random(8, "bim.generate");
  for (const double tilt : {0.0, 0.5}) {
    const Eigen::Quaterniond q(Eigen::AngleAxisd(tilt, Eigen::Vector3d(0.6, 0.8, 0.0)));
    const Points up = posts(random, 0, 20), flat = ground();
    Points all_R;
    std::vector<Surfel> surfels;
    for (const Eigen::Vector3d& p : up) all_R.push_back(q * p);
    for (const Eigen::Vector3d& p : flat) all_R.push_back(q * p);
    for (const Eigen::Vector3d& p : flat) surfels.push_back({q * p, q * Eigen::Vector3d::UnitZ(), 0.0F});
    const Points standing = standing_returns(all_R, surfels);
    const auto on_posts = std::count_if(standing.begin(), standing.end(),
                                        [&](const Eigen::Vector3d& p_R) { return (q.inverse() * p_R).z() > -0.75; });
    EXPECT_EQ(on_posts, static_cast<std::ptrdiff_t>(up.size()));
    EXPECT_LT(standing.size() - up.size(), flat.size() / 20) << "only where a post stands on a ring";
  }
}

TEST(Correlation, TurnsAreNoMovements) {
  Vector6d turn = Vector6d::Zero();
  turn(5) = 0.1;
  Vector6d mostly_along = 0.9 * along(0.3);
  mostly_along(5) = 0.02;
  const std::vector<Vector6d> directions = {turn, mostly_along, along(0.3 + M_PI / 2.0), Vector6d(Vector6d::Unit(2))};
  const std::vector<Vector6d> moves = movements(directions);
  ASSERT_EQ(moves.size(), 2U) << "of three the first two";
  EXPECT_NEAR(moves[0].head<3>().norm(), 1.0, 1e-12);
  EXPECT_EQ(directions_beside(directions, moves), 2) << "the turn and z";
  EXPECT_EQ(directions_beside(directions, {}), 4);
}

TEST(Correlation, ThinsReturnsToOneAVoxel) {
  DeskewedScan scan;
  scan.point_R = {{1.0, 0.1, 0.1}, {1.01, 0.1, 0.1}, {9.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {2.0, 0.1, 0.1}};
  scan.range_m = {1.0, 1.01, 9.0, 0.0, 2.0};
  const Points thinned = thinned_returns(scan, 0.5, 5.0);
  ASSERT_EQ(thinned.size(), 2U);
  EXPECT_EQ(thinned[0].x(), 1.0);
  EXPECT_EQ(thinned[1].x(), 2.0);
}

}  // namespace
}  // namespace plumbline::slam
