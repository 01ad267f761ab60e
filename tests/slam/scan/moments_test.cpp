// SPDX-License-Identifier: Apache-2.0
#include "slam/scan/moments.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bim/geometry/symmetric.h"
#include "bim/random/stream.h"
#include "slam/planes/plane_detector.h"

namespace plumbline::slam {
namespace {

Plane random_plane(const Stream& random, std::uint64_t k) {
  const Eigen::Vector3d n(random.gauss(k, 0), random.gauss(k, 1), random.gauss(k, 2));
  return {n.normalized(), 3.0 * random.gauss(k, 3)};
}

/// Points of a 4 x 2 m patch about 3 m beside the foot of the origin, with noise across.
Moments patch(const Stream& random, const Plane& plane, std::uint64_t k, double sigma) {
  const Tangents t = plane_tangents(plane.n);
  Moments moments;
  for (std::uint32_t i = 0; i < 200; ++i)
    moments.add(-plane.d * plane.n + (1.0 + 4.0 * random.uniform(k, 10 + i, 0)) * t.u +
                2.0 * random.uniform(k, 10 + i, 1) * t.v + sigma * random.gauss(k, 10 + i, 2) * plane.n);
  return moments;
}

TEST(MomentsTest, RefiningFindsTheLeastSquaresPlane) {
  const Stream random(11, "bim.generate");
  for (std::uint64_t k = 0; k < 100; ++k) {
    const Plane truth = random_plane(random, k);
    const Moments moments = patch(random, truth, k, 0.02);
    Plane plane = truth;
    for (int i = 0; i < 4; ++i) plane = refine_plane(moments, plane, 0.0);
    const Eigen::Vector3d c = moments.mean();
    const Eigen::Matrix3d s = moments.outer / moments.n - c * c.transpose();
    const SymmetricEigen<3> eigen = symmetric_eigen(s);
    const Eigen::Vector3d n = eigen.vectors.col(0);
    EXPECT_LT((plane.n * std::copysign(1.0, plane.n.dot(n)) - n).norm(), 1e-5);
    EXPECT_NEAR(plane.distance(c), 0.0, 1e-6);
    EXPECT_NEAR(plane_rms(moments, plane), std::sqrt(eigen.values(0)), 1e-7);
  }
}

TEST(MomentsTest, PoolingEqualsAddingAllPoints) {
  const Stream random(12, "bim.generate");
  const Plane plane = random_plane(random, 0);
  Moments pooled = patch(random, plane, 0, 0.01);
  const Moments b = patch(random, plane, 1, 0.01);
  pooled.add(b);
  EXPECT_DOUBLE_EQ(pooled.n, 400.0);
  EXPECT_LT(plane_rms(pooled, plane), 0.02);
}

// The spread of 400 fits is the predicted covariance; their sample variance scatters by sqrt(2 / 400) = 7 %.
TEST(MomentsTest, AlongAnAxisTheyMoveAsAnyWay) {
  const Stream random(15, "bim.generate");
  for (std::uint64_t k = 0; k < 200; ++k) {
    const Moments moments = patch(random, random_plane(random, k), k, 0.02);
    const int axis = static_cast<int>(k % 3);
    const double by = random.gauss(k, 5);
    const Moments along = moments.moved_along(axis, by), moved = moments.moved(by * Eigen::Vector3d::Unit(axis));
    EXPECT_EQ(along.n, moved.n);
    EXPECT_EQ(along.sum, moved.sum);
    EXPECT_EQ(along.outer, moved.outer);
  }
}

TEST(MomentsTest, CovarianceIsTheSpreadOfFits) {
  const Stream random(13, "bim.generate");
  const Plane truth = random_plane(random, 1000);
  const Tangents t = plane_tangents(truth.n);
  const double sigma = 0.015;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d predicted = Eigen::Matrix3d::Zero();
  constexpr int fits = 400;
  for (std::uint64_t k = 0; k < fits; ++k) {
    const Moments moments = patch(random, truth, k, sigma);
    const Plane plane = refine_plane(moments, truth, 0.0);
    const Eigen::Vector3d e(t.u.dot(plane.n), t.v.dot(plane.n), plane.d - truth.d);
    spread += e * e.transpose() / fits;
    predicted += plane_covariance(moments, truth, sigma, Eigen::Vector3d::Zero()) / fits;
  }
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(spread(i, i) / predicted(i, i), 1.0, 0.3);
}

TEST(MomentsTest, BiasActsAtTheCentroid) {
  const Stream random(14, "bim.generate");
  const Plane plane = random_plane(random, 5);
  const Moments moments = patch(random, plane, 5, 0.0);
  const Eigen::Matrix3d covariance = plane_covariance(moments, plane, 0.0, {0.003, 0.005, 0.02});
  const Tangents t = plane_tangents(plane.n);
  const Eigen::Vector3d c = moments.mean();
  // Variance of the signed distance of the centroid: J = (u.c, v.c, 1).
  const Eigen::Vector3d j(t.u.dot(c), t.v.dot(c), 1.0);
  EXPECT_NEAR(std::sqrt(j.dot(covariance * j)), 0.02, 1e-9);
  EXPECT_NEAR(std::sqrt(covariance(0, 0)), 0.003, 1e-12);
  EXPECT_NEAR(std::sqrt(covariance(1, 1)), 0.005, 1e-12);
}

}  // namespace
}  // namespace plumbline::slam
