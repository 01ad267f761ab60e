// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/ukf/unscented.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "bim/random/stream.h"

namespace plumbline::slam {
namespace {

Eigen::MatrixXd random_matrix(const Stream& stream, std::uint64_t tick, Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd A(rows, columns);
  for (Eigen::Index r = 0; r < rows; ++r)
    for (Eigen::Index c = 0; c < columns; ++c)
      A(r, c) = stream.gauss(tick, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(c));
  return A;
}

Eigen::MatrixXd positive(const Eigen::MatrixXd& A) {
  return A * A.transpose() + 0.1 * Eigen::MatrixXd::Identity(A.rows(), A.rows());
}

TEST(Unscented, IsTheKalmanFilterOfALinearSystem) {
  const Stream stream(4, "bim.generate");
  constexpr Eigen::Index n = 6, m = 3;
  Eigen::VectorXd x = random_matrix(stream, 1, n, 1);
  Eigen::MatrixXd P = positive(random_matrix(stream, 2, n, n));
  UnscentedFilter filter(x, P);
  for (std::uint64_t k = 0; k < 40; ++k) {
    const Eigen::MatrixXd F = Eigen::MatrixXd::Identity(n, n) + 0.2 * random_matrix(stream, 10 * k + 10, n, n);
    const Eigen::MatrixXd H = random_matrix(stream, 10 * k + 11, m, n);
    const Eigen::MatrixXd Q = 0.1 * positive(random_matrix(stream, 10 * k + 12, n, n));
    const Eigen::MatrixXd R = positive(random_matrix(stream, 10 * k + 13, m, m));
    const Eigen::VectorXd z = random_matrix(stream, 10 * k + 14, m, 1);
    filter.predict([&](const Eigen::VectorXd& v) { return Eigen::VectorXd(F * v); }, Q);
    filter.correct([&](const Eigen::VectorXd& v) { return Eigen::VectorXd(H * v); }, z, R);
    x = F * x;
    P = F * P * F.transpose() + Q;
    const Eigen::MatrixXd S = H * P * H.transpose() + R;
    const Eigen::MatrixXd K = P * H.transpose() * S.inverse();
    x += K * (z - H * x);
    P -= K * S * K.transpose();
    const double scale = 1.0 + P.norm();
    ASSERT_LT((filter.mean() - x).norm(), 1e-8 * scale) << "step " << k;
    ASSERT_LT((filter.covariance() - P).norm(), 1e-8 * scale) << "step " << k;
  }
}

TEST(Unscented, RootOfWhatIsNotPositiveIsThatOfTheNearestThatIs) {
  const Stream stream(5, "bim.generate");
  for (std::uint64_t i = 0; i < 50; ++i) {
    const Eigen::MatrixXd A = positive(random_matrix(stream, i, 7, 7));
    const Eigen::MatrixXd L = square_root(A);
    EXPECT_LT((L * L.transpose() - A).norm(), 1e-10 * A.norm());
    const Eigen::VectorXd v = random_matrix(stream, i + 1000, 7, 1).normalized();
    const double below = v.dot(A * v) * (1.0 + 1e-9);
    const Eigen::MatrixXd B = A - below * v * v.transpose();  // no longer positive definite, by little
    const Eigen::MatrixXd M = square_root(B);
    ASSERT_TRUE(M.allFinite());
    EXPECT_LE((M * M.transpose() - B).norm(), 1.01 * A.norm());
  }
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(3, 3);
  EXPECT_TRUE(square_root(none).allFinite());
  EXPECT_TRUE(square_root(-Eigen::MatrixXd::Identity(3, 3)).allFinite());
}

}  // namespace
}  // namespace plumbline::slam
