// SPDX-License-Identifier: Apache-2.0
#include "bim/geometry/best_rotation.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace plumbline
