// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/ukf/unscented.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "bim/geometry/symmetric.h"

namespace plumbline::slam {

Eigen::MatrixXd square_root(const Eigen::MatrixXd& A) {
  const Eigen::LLT<Eigen::MatrixXd> root(A);
  if (root.info() == Eigen::Success) return root.matrixL();
  const auto eigen = symmetric_eigen(Eigen::MatrixXd(0.5 * (A + A.transpose())));
  const double floor = std::max(1e-12 * eigen.values.cwiseAbs().maxCoeff(), 1e-300);
  return eigen.vectors * eigen.values.cwiseMax(floor).cwiseSqrt().asDiagonal();
}

UnscentedFilter::UnscentedFilter(Eigen::VectorXd mean, Eigen::MatrixXd covariance, double lambda)
    : mean_(std::move(mean)), covariance_(std::move(covariance)), lambda_(lambda) {}

double UnscentedFilter::weight(Eigen::Index k) const {
  const double n = static_cast<double>(mean_.size());
  return (k == 0 ? lambda_ : 0.5) / (n + lambda_);
}

Eigen::MatrixXd UnscentedFilter::sigma_points() const {
  const Eigen::Index n = mean_.size();
  const Eigen::MatrixXd L = square_root((static_cast<double>(n) + lambda_) * covariance_);
  Eigen::MatrixXd points = mean_.replicate(1, 2 * n + 1);
  points.middleCols(1, n) += L;
  points.rightCols(n) -= L;
  return points;
}

void UnscentedFilter::predict(const Map& f, const Eigen::MatrixXd& Q) {
  Eigen::MatrixXd points = sigma_points();
  mean_.setZero();
  for (Eigen::Index k = 0; k < points.cols(); ++k) {
    points.col(k) = f(points.col(k));
    mean_ += weight(k) * points.col(k);
  }
  points.colwise() -= mean_;
  covariance_ = Q;
  for (Eigen::Index k = 0; k < points.cols(); ++k)
    covariance_.noalias() += weight(k) * points.col(k) * points.col(k).transpose();
}

void UnscentedFilter::correct(const Map& h, const Eigen::VectorXd& z, const Eigen::MatrixXd& R) {
  Eigen::MatrixXd points = sigma_points();
  Eigen::MatrixXd seen(z.size(), points.cols());
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(z.size());
  for (Eigen::Index k = 0; k < points.cols(); ++k) {
    seen.col(k) = h(points.col(k));
    expected += weight(k) * seen.col(k);
  }
  points.colwise() -= mean_;
  seen.colwise() -= expected;
  Eigen::MatrixXd S = R, C = Eigen::MatrixXd::Zero(mean_.size(), z.size());
  for (Eigen::Index k = 0; k < points.cols(); ++k) {
    S.noalias() += weight(k) * seen.col(k) * seen.col(k).transpose();
    C.noalias() += weight(k) * points.col(k) * seen.col(k).transpose();
  }
  const Eigen::MatrixXd K = S.ldlt().solve(C.transpose()).transpose();
  mean_ += K * (z - expected);
  covariance_ -= K * S * K.transpose();
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
}

}  // namespace plumbline::slam
