// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>

namespace plumbline::slam {

/// Unscented Kalman filter with additive noise. Weights: lambda / (n + lambda) for the mean's own point, 1 / (2 (n +
/// lambda)) for each of the 2n others. For linear maps it is the Kalman filter.
class UnscentedFilter {
 public:
  using Map = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

  UnscentedFilter(Eigen::VectorXd mean, Eigen::MatrixXd covariance, double lambda = 1.0);

  void predict(const Map& f, const Eigen::MatrixXd& Q);
  /// z is taken as h(x) plus noise.
  void correct(const Map& h, const Eigen::VectorXd& z, const Eigen::MatrixXd& R);

  [[nodiscard]] const Eigen::VectorXd& mean() const { return mean_; }
  [[nodiscard]] const Eigen::MatrixXd& covariance() const { return covariance_; }
  void set_mean(const Eigen::VectorXd& mean) { mean_ = mean; }

 private:
  /// One point a column, the mean first.
  [[nodiscard]] Eigen::MatrixXd sigma_points() const;
  [[nodiscard]] double weight(Eigen::Index k) const;

  Eigen::VectorXd mean_;
  Eigen::MatrixXd covariance_;
  double lambda_;
};

/// L with L L' = A for a symmetric A; where A is not positive definite, of the nearest matrix whose eigenvalues are at
/// least 1e-12 of the largest. Never NaN for a finite A.
[[nodiscard]] Eigen::MatrixXd square_root(const Eigen::MatrixXd& A);

}  // namespace plumbline::slam
