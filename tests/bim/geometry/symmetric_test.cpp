// SPDX-License-Identifier: Apache-2.0
#include "bim/geometry/symmetric.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "bim/random/stream.h"

namespace plumbline {
namespace {

Eigen::MatrixXd random_matrix(const Stream& random, std::uint64_t tick, Eigen::Index rows, Eigen::Index cols) {
  return Eigen::MatrixXd::NullaryExpr(rows, cols, [&](Eigen::Index i, Eigen::Index j) {
    return random.gauss(tick, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
  });
}

template <int N>
void expect_laws(const Stream& random, Eigen::Index n) {
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    const Eigen::MatrixXd root = random_matrix(random, 2 * trial, n, n);
    const Eigen::Matrix<double, N, N> A = root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(n, n);
    const SymmetricEigen<N> eigen = symmetric_eigen(A);
    const double tolerance = 1e-12 * (1.0 + A.norm());  // 4,500 roundings of |A|
    EXPECT_LT((A * eigen.vectors - eigen.vectors * eigen.values.asDiagonal()).norm(), tolerance);
    EXPECT_LT((eigen.vectors.transpose() * eigen.vectors - Eigen::MatrixXd::Identity(n, n)).norm(), 1e-12);
    for (Eigen::Index k = 1; k < n; ++k) EXPECT_LE(eigen.values(k - 1), eigen.values(k));
    if constexpr (N != 2) {
      const Eigen::Matrix<double, N, 1> b = random_matrix(random, 2 * trial + 1, n, 1);
      // |x| is at most |b| / 0.1, the least eigenvalue; |b| of nine normal numbers stays below 1 + |A|.
      EXPECT_LT((A * solve_ldlt(A, b) - b).norm(), 10.0 * tolerance * (1.0 + A.norm()));
    }
  }
}

TEST(Symmetric, EigenvectorsAndSolutionsHoldForEachSize) {
  const Stream random(15, "bim.generate");
  expect_laws<2>(random, 2);
  expect_laws<3>(random, 3);
  expect_laws<6>(random, 6);
  expect_laws<Eigen::Dynamic>(random, 9);
}

}  // namespace
}  // namespace plumbline
