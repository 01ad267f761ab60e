// SPDX-License-Identifier: Apache-2.0
#include "bim/geometry/pose.h"

#include <gtest/gtest.h>

#include <numbers>

#include "bim/geometry/plane.h"
#include "bim/random/stream.h"

namespace plumbline {
namespace {

constexpr int trials = 1000;
// A few dozen roundings of numbers up to about 10.
constexpr double tolerance = 1e-12;

class PoseLaws : public ::testing::Test {
 protected:
  [[nodiscard]] Vector6d twist(int i, std::uint32_t lane) const {
    Vector6d xi;
    for (std::uint32_t k = 0; k < 6; ++k) xi(k) = stream_.gauss(static_cast<std::uint64_t>(i), lane, k);
    return xi;
  }
  [[nodiscard]] Pose pose(int i, std::uint32_t lane) const { return exp_se3(twist(i, lane)); }
  [[nodiscard]] Eigen::Vector3d point(int i, std::uint32_t lane) const { return twist(i, lane).head<3>(); }

 private:
  Stream stream_{11, "bim.generate"};
};

void expect_near(const Pose& a, const Pose& b) {
  EXPECT_LT((a.t - b.t).norm(), tolerance * 10);
  EXPECT_LT(log_so3(a.q.conjugate() * b.q).norm(), tolerance * 10);
}

TEST_F(PoseLaws, IsAGroup) {
  for (int i = 0; i < trials; ++i) {
    const Pose a = pose(i, 0);
    const Pose b = pose(i, 1);
    const Pose c = pose(i, 2);
    expect_near((a * b) * c, a * (b * c));
    expect_near(a * a.inverse(), Pose{});
    expect_near(a * Pose{}, a);
  }
}

TEST_F(PoseLaws, ActsOnPoints) {
  for (int i = 0; i < trials; ++i) {
    const Eigen::Vector3d p = point(i, 3);
    EXPECT_LT(((pose(i, 0) * pose(i, 1)) * p - pose(i, 0) * (pose(i, 1) * p)).norm(), tolerance * 10);
  }
}

TEST_F(PoseLaws, LogInvertsExp) {
  for (int i = 0; i < trials; ++i) {
    Vector6d xi = twist(i, 0);
    const double angle = xi.tail<3>().norm();
    if (angle > 3.0) xi.tail<3>() *= 3.0 / angle;
    // The inverse left Jacobian amplifies rounding by up to about 1 / (pi - angle).
    EXPECT_LT((log_se3(exp_se3(xi)) - xi).norm(), 1e-9);
    EXPECT_LT((log_se3(exp_se3(xi * 1e-7)) - xi * 1e-7).norm(), 1e-14);
  }
}

TEST_F(PoseLaws, AdjointTakesIncrementsToTheOtherSide) {
  for (int i = 0; i < trials; ++i) {
    const Pose X = pose(i, 0), Y = pose(i, 1);
    Vector6d xi = twist(i, 2);
    const double angle = xi.tail<3>().norm();
    if (angle > 3.0) xi.tail<3>() *= 3.0 / angle;
    expect_near(exp_se3(adjoint(X) * xi) * X, X * exp_se3(xi));
    EXPECT_LT((adjoint(X * Y) - adjoint(X) * adjoint(Y)).norm(), tolerance * 100);
  }
}

TEST_F(PoseLaws, PlaneTransformFollowsItsPoints) {
  for (int i = 0; i < trials; ++i) {
    const Plane plane_B{point(i, 4).normalized(), 1.7};
    const Eigen::Vector3d p_B = point(i, 5);
    const Pose X_AB = pose(i, 0);
    EXPECT_NEAR((X_AB * plane_B).distance(X_AB * p_B), plane_B.distance(p_B), tolerance * 10);
    const Plane back = X_AB.inverse() * (X_AB * plane_B);
    EXPECT_LT((back.n - plane_B.n).norm(), tolerance * 10);
    EXPECT_NEAR(back.d, plane_B.d, tolerance * 10);
  }
}

TEST_F(PoseLaws, InterpolatesBetweenItsEnds) {
  for (int i = 0; i < trials; ++i) {
    const Pose a = pose(i, 0);
    const Pose b = a * exp_se3(0.3 * twist(i, 1));
    expect_near(interpolate(a, b, 0.0), a);
    expect_near(interpolate(a, b, 1.0), b);
    expect_near(interpolate(a, b, 0.25), interpolate(b, a, 0.75));
  }
}

TEST_F(PoseLaws, YawOfAPlanarPose) {
  for (int i = 0; i < trials; ++i) {
    const double yaw = wrap_angle(10.0 * twist(i, 0)(0));
    EXPECT_NEAR(Pose::from_xyz_yaw(Eigen::Vector3d::Zero(), yaw).yaw(), yaw, tolerance);
  }
  EXPECT_EQ(wrap_angle(std::numbers::pi), std::numbers::pi);
  EXPECT_EQ(wrap_angle(-std::numbers::pi), std::numbers::pi);
  for (double angle = -20.0; angle < 20.0; angle += 0.0113)
    EXPECT_EQ(wrap_angle(angle), std::remainder(angle, 2.0 * std::numbers::pi));
}

}  // namespace
}  // namespace plumbline
