// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/mloam/uncertainty.h"

namespace plumbline::slam::mloam {

Eigen::Matrix3d point_covariance(const Pose& X_AB, const Matrix6d& covariance_AB, const Eigen::Vector3d& p_B,
                                 const Eigen::Matrix3d& covariance_p) {
  Eigen::Matrix<double, 3, 6> G;
  G.leftCols<3>().setIdentity();
  G.rightCols<3>() = -hat(X_AB * p_B);
  const Eigen::Matrix3d R = X_AB.rotation();
  return G * covariance_AB * G.transpose() + R * covariance_p * R.transpose();
}

}  // namespace plumbline::slam::mloam
