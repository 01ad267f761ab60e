// SPDX-License-Identifier: Apache-2.0
#include "bim/geometry/best_rotation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bim/geometry/pose.h"

namespace plumbline {
namespace {

TEST(BestRotation, TurnsThePointsOntoTheOthers) {
  const Eigen::Matrix3d R = exp_so3({0.4, -1.1, 2.0}).toRotationMatrix();
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero(), mirrored = sum;
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(1, 0, 0), {0, 2, 0}, {0, 0, 3}, {-1, -2, -3}}) {
    sum += R * p * p.transpose();
    mirrored += Eigen::Vector3d(p.x(), p.y(), -p.z()) * p.transpose();
  }
  EXPECT_LT((best_rotation(sum) - R).norm(), 1e-12);
  EXPECT_NEAR(best_rotation(mirrored).determinant(), 1.0, 1e-12);  // never a reflection
}

TEST(RotationBetween, TurnsByTheAngleBetweenThem) {
  const Eigen::Vector3d a(1.0, 2.0, -0.5);
  for (const Eigen::Vector3d& b : {Eigen::Vector3d(0, 0, 3), {1, 2, -0.5}, {-1, -2, 0.5}, {0.3, -4, 1}}) {
    const Eigen::Quaterniond q = rotation_between(a, b);
    EXPECT_LT((q * a.normalized() - b.normalized()).norm(), 1e-12);
    // acos near -1 and 1 keeps half of the digits.
    EXPECT_NEAR(q.angularDistance(Eigen::Quaterniond::Identity()),
                std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0)), 1e-7);
  }
}

}  // namespace
}  // namespace plumbline
