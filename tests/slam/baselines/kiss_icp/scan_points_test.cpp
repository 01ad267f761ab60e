// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/kiss_icp/scan_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bim/random/stream.h"

namespace plumbline::slam::kiss {
namespace {

constexpr Nanoseconds period = 100'000'000;

/// A motion of 0.8 m with a turn of half a radian, about no axis of L.
Pose large_motion() { return exp_se3((Vector6d() << 0.7, -0.3, 0.2, 0.2, -0.3, 0.35).finished()); }

/// A scan of a room's walls, x and y in [-4, 6] m, by a LiDAR that moves evenly: by `motion` in each period, ending at
/// M's origin.
Scan scan_in_motion(const Pose& motion, Nanoseconds duration, double noise_m) {
  const Stream random(11, "bim.generate");
  const Vector6d xi = log_se3(motion);
  Scan scan;
  scan.rings = 4;
  scan.columns = 500;
  for (int i = 0; i < scan.rings * scan.columns; ++i) {
    const auto tick = static_cast<std::uint64_t>(i);
    const auto draw = [&](std::uint32_t lane) { return random.uniform(tick, lane); };
    Eigen::Vector3d p_M(10.0 * draw(0) - 4.0, 10.0 * draw(1) - 4.0, 3.0 * draw(2) - 1.0);
    p_M[i % 2] = (draw(3) < 0.5 ? -4.0 : 6.0) + noise_m * random.gauss(tick, 4);
    const auto offset = static_cast<std::int32_t>(-duration + duration * i / (scan.rings * scan.columns - 1));
    const Pose X_ML = exp_se3(xi * static_cast<double>(offset) / static_cast<double>(period));
    scan.point_L.push_back(X_ML.inverse() * p_M);
    scan.range_m.push_back(scan.point_L.back().norm());
    scan.offset_ns.push_back(offset);
  }
  return scan;
}

double distance_to_wall(const Eigen::Vector3d& p_M) {
  return std::min({std::abs(p_M.x() + 4.0), std::abs(p_M.x() - 6.0), std::abs(p_M.y() + 4.0), std::abs(p_M.y() - 6.0)});
}

TEST(ConstantTwist, IsTheExponentialOfItsPart) {
  for (const Pose& motion : {large_motion(), exp_se3((Vector6d() << 0.7, -0.3, 0.2, 0, 0, 0).finished()),
                             exp_se3((Vector6d() << 0.7, -0.3, 0.2, 1e-7, 0, -2e-7).finished())}) {
    const ConstantTwist twist(motion, period);
    const Eigen::Vector3d p(3.0, -40.0, 7.0);
    EXPECT_LT((twist.to_stamp(p, 0) - p).norm(), 1e-15);
    EXPECT_LT((twist.to_stamp(p, -period) - motion.inverse() * p).norm(), 1e-12);
    const Pose part = exp_se3(-0.37 * log_se3(motion));
    EXPECT_LT((twist.to_stamp(p, -37'000'000) - part * p).norm(), 1e-12);
  }
  EXPECT_EQ(ConstantTwist().to_stamp({1.0, 2.0, 3.0}, -period), Eigen::Vector3d(1.0, 2.0, 3.0));
}

TEST(DeskewedPoints, LieOnTheWallsAfterAConstantTwist) {
  const Scan scan = scan_in_motion(large_motion(), period, 0.0);
  const ScanPoints still = deskewed_points(scan, {}, 0.0, 100.0);
  const ScanPoints moved = deskewed_points(scan, ConstantTwist(large_motion(), period), 0.0, 100.0);
  ASSERT_EQ(moved.points_L.size(), scan.size());
  double skew = 0.0;
  for (std::size_t k = 0; k < scan.size(); ++k) {
    EXPECT_LT(distance_to_wall(moved.points_L[k]), 1e-9);
    skew = std::max(skew, distance_to_wall(still.points_L[k]));
  }
  EXPECT_GT(skew, 0.5) << "or there is nothing to undo";
}

TEST(DeskewedPoints, KeepTheNoiseOfTheirRanges) {
  constexpr double noise_m = 0.01;
  const Scan scan = scan_in_motion(large_motion(), period, noise_m);
  double sum = 0.0;
  for (const Eigen::Vector3d& p : deskewed_points(scan, ConstantTwist(large_motion(), period), 0.0, 100.0).points_L)
    sum += std::pow(distance_to_wall(p), 2);
  EXPECT_LT(std::sqrt(sum / static_cast<double>(scan.size())), 1.05 * noise_m);
}

TEST(DeskewedPoints, AreReturnsBetweenTheRangesInOrder) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  Scan scan;
  scan.rings = 1;
  const std::vector<Eigen::Vector3d> points = {{5, 0, 0},   {1, 0, 0}, {10, 0, 0},   {0, 3, 0}, {nan, 1, 1},
                                               {1, inf, 1}, {0, 0, 0}, {0, -2, 1.5}, {4, 0, 0}, {1e200, 1e200, 0}};
  for (const Eigen::Vector3d& p : points) {
    scan.point_L.push_back(p);
    scan.range_m.push_back(p.norm());
    ++scan.columns;
  }
  scan.range_m[8] = 0.0;  // no return
  scan.range_m[4] = 1.0;
  const ScanPoints kept = deskewed_points(scan, {}, 1.0, 10.0);  // no times at all
  EXPECT_EQ(kept.slots, (std::vector<std::size_t>{0, 3, 7}));
  EXPECT_EQ(kept.points_L.at(2), points[7]);
  EXPECT_TRUE(deskewed_points({}, {}, 0.0, 10.0).slots.empty());
}

TEST(SweepDuration, IsZeroWhereAScanHasNoTimes) {
  Scan scan = scan_in_motion({}, period, 0.0);
  EXPECT_EQ(sweep_duration(scan), period);
  scan.range_m.front() = 0.0;
  EXPECT_LT(sweep_duration(scan), period) << "the first slot is no return";
  scan.offset_ns.assign(scan.size(), -5);
  EXPECT_EQ(sweep_duration(scan), 0);
  scan.offset_ns.clear();
  EXPECT_EQ(sweep_duration(scan), 0);
  EXPECT_EQ(sweep_duration({}), 0);
  scan.offset_ns.assign(scan.size(), 0);
  scan.range_m.assign(scan.size(), 0.0);
  EXPECT_EQ(sweep_duration(scan), 0);
}

TEST(FirstOfVoxels, KeepsFirstPointsAsTheyAre) {
  const std::vector<Eigen::Vector3d> points = {{0.9, 0.1, 0.1}, {0.1, 0.1, 0.1}, {-0.1, 0.1, 0.1}, {1.1, 0.1, 0.1},
                                               {0.5, 0.5, 0.5}, {1.0, 0.0, 0.0}, {-0.9, 0.9, 0.9}};
  EXPECT_EQ(first_of_voxels(points, 1.0), (std::vector<Eigen::Vector3d>{points[0], points[2], points[3]}));
  EXPECT_TRUE(first_of_voxels({}, 1.0).empty());
}

}  // namespace
}  // namespace plumbline::slam::kiss
