// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/forms.h"

#include <gtest/gtest.h>

#include <numbers>

#include "bim/random/stream.h"
#include "tests/slam/planes/plane_forms.h"

namespace plumbline::slam {
namespace {

constexpr int trials = 500;

Plane random_plane(std::uint64_t k, std::uint32_t lane) {
  const Stream random(3, "bim.generate");
  const Eigen::Vector3d n(random.gauss(k, lane, 0), random.gauss(k, lane, 1), random.gauss(k, lane, 2));
  return {n.normalized(), 20.0 * (random.uniform(k, lane, 3) - 0.5)};
}

Pose random_pose(std::uint64_t k) {
  const Stream random(4, "bim.generate");
  const auto g = [&](std::uint32_t draw) { return random.gauss(k, 0, draw); };
  return {exp_so3({g(0), g(1), g(2)}), {5.0 * g(3), 5.0 * g(4), g(5)}};
}

void expect_same(const Plane& a, const Plane& b) {
  EXPECT_LT((a.n - b.n).norm(), 1e-12);  // a few roundings of numbers up to 1
  EXPECT_NEAR(a.d, b.d, 1e-12);
}

TEST(PlaneForms, AnglesGiveThePlaneBack) {
  for (std::uint64_t k = 0; k < trials; ++k)
    expect_same(from_angles(to_angles(random_plane(k, 0))), random_plane(k, 0));
  for (const double z : {1.0, -1.0}) {
    const Plane level{{0.0, 0.0, z}, 0.4};
    EXPECT_EQ(to_angles(level).azimuth, 0.0);
    expect_same(from_angles(to_angles(level)), level);
  }
}

TEST(PlaneForms, TheDifferenceIsZeroForEqualPlanesOnly) {
  for (std::uint64_t k = 0; k < trials; ++k) {
    const Plane a = random_plane(k, 0), b = random_plane(k, 1);
    EXPECT_LT(angle_difference(a, a).norm(), 1e-12);
    EXPECT_GT(angle_difference(a, b).norm(), 1e-3);
  }
}

// The normal of b is at (azimuth, elevation) of the difference as seen from a, so the angle between both normals is
// that between the x axis and this direction.
TEST(PlaneForms, TheDifferenceHoldsTheAngleBetweenNormals) {
  for (std::uint64_t k = 0; k < trials; ++k) {
    const Plane a = random_plane(k, 0), b = random_plane(k, 1);
    const Eigen::Vector3d e = angle_difference(a, b);
    EXPECT_NEAR(std::cos(e.x()) * std::cos(e.y()), a.n.dot(b.n), 1e-12);
    EXPECT_NEAR(e.z(), b.d - a.d, 1e-12);
  }
}

TEST(PlaneForms, TheAxisOfANormalTurnsWithIt) {
  EXPECT_EQ(axis_of({0.8, -0.6, 0.0}), PlaneAxis::x);
  EXPECT_EQ(axis_of({0.6, -0.8, 0.0}), PlaneAxis::y);
  EXPECT_EQ(axis_of({0.1, 0.1, -0.9}), PlaneAxis::horizontal);
  const Pose quarter = Pose::from_xyz_yaw(Eigen::Vector3d::Zero(), std::numbers::pi / 2.0);
  for (std::uint64_t k = 0; k < trials; ++k) {
    const Plane plane = random_plane(k, 2);
    const PlaneAxis axis = axis_of(plane.n), turned = axis_of((quarter * plane).n);
    if (axis == PlaneAxis::horizontal) {
      EXPECT_EQ(turned, axis);
    } else {
      EXPECT_EQ(turned, axis == PlaneAxis::x ? PlaneAxis::y : PlaneAxis::x);
    }
    EXPECT_EQ(axis_of(plane.flipped().n), axis);
    // A pose leaves distances of points, and with them both forms' meaning, alone.
    const Pose X = random_pose(k);
    const Eigen::Vector3d p = closest_point(plane);
    EXPECT_NEAR((X * plane).distance(X * p), 0.0, 1e-11);
  }
}

}  // namespace
}  // namespace plumbline::slam
