// SPDX-License-Identifier: Apache-2.0
#include "slam/loam/degeneracy.h"

#include <gtest/gtest.h>

namespace plumbline::slam::loam {
namespace {

TEST(GoodDirections, AreThoseOfLargeEigenvalues) {
  // Eigenvalues 100 along (1, 1), 1 along (1, -1).
  const Eigen::MatrixXd normal = (Eigen::Matrix2d() << 50.5, 49.5, 49.5, 50.5).finished();
  const GoodDirections one = good_directions(normal, 10.0);
  EXPECT_EQ(one.degenerate, 1);
  EXPECT_LT((one.projection - Eigen::Matrix2d::Constant(0.5)).norm(), 1e-12);
  EXPECT_EQ(good_directions(normal, 0.5).degenerate, 0);
  EXPECT_EQ(good_directions(Eigen::MatrixXd::Zero(3, 3), 0.1).degenerate, 3);
}

}  // namespace
}  // namespace plumbline::slam::loam
