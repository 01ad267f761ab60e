// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/mloam/uncertainty.h"

namespace plumbline::slam::mloam {

namespace {

/// <<M>> of [barfoot2014].
Eigen::Matrix3d less_trace(const Eigen::Matrix3d& M) { return M - M.trace() * Eigen::Matrix3d::Identity(); }
Eigen::Matrix3d less_traces(const Eigen::Matrix3d& M, const Eigen::Matrix3d& N) {
  return less_trace(M) * less_trace(N) + less_trace(N * M);
}

Matrix6d second_moment(const Matrix6d& S) {
  const Eigen::Matrix3d rotation = S.bottomRightCorner<3, 3>();
  const Eigen::Matrix3d mixed = S.topRightCorner<3, 3>() + S.bottomLeftCorner<3, 3>();
  Matrix6d A = Matrix6d::Zero();
  A.topLeftCorner<3, 3>() = A.bottomRightCorner<3, 3>() = less_trace(rotation);
  A.topRightCorner<3, 3>() = less_trace(mixed);
  return A;
}

}  // namespace

Matrix6d compound_covariance(const Pose& X_AB, const Matrix6d& covariance_AB, const Matrix6d& covariance_BC) {
  const Matrix6d Ad = adjoint(X_AB);
  const Matrix6d& S1 = covariance_AB;
  const Matrix6d S2 = Ad * covariance_BC * Ad.transpose();
  const Eigen::Matrix3d r1 = S1.topLeftCorner<3, 3>(), m1 = S1.topRightCorner<3, 3>(),
                        p1 = S1.bottomRightCorner<3, 3>();
  const Eigen::Matrix3d r2 = S2.topLeftCorner<3, 3>(), m2 = S2.topRightCorner<3, 3>(),
                        p2 = S2.bottomRightCorner<3, 3>();
  Matrix6d B;
  B.topLeftCorner<3, 3>() =
      less_traces(p1, r2) + less_traces(m1.transpose(), m2) + less_traces(m1, m2.transpose()) + less_traces(r1, p2);
  B.topRightCorner<3, 3>() = less_traces(p1, m2.transpose()) + less_traces(m1.transpose(), p2);
  B.bottomLeftCorner<3, 3>() = B.topRightCorner<3, 3>().transpose();
  B.bottomRightCorner<3, 3>() = less_traces(p1, p2);
  const Matrix6d A1 = second_moment(S1), A2 = second_moment(S2);
  return S1 + S2 + 0.25 * B + (A1 * S2 + S2 * A1.transpose() + A2 * S1 + S1 * A2.transpose()) / 12.0;
}

Eigen::Matrix3d point_covariance(const Pose& X_AB, const Matrix6d& covariance_AB, const Eigen::Vector3d& p_B,
                                 const Eigen::Matrix3d& covariance_p) {
  Eigen::Matrix<double, 3, 6> G;
  G.leftCols<3>().setIdentity();
  G.rightCols<3>() = -hat(X_AB * p_B);
  const Eigen::Matrix3d R = X_AB.rotation();
  return G * covariance_AB * G.transpose() + R * covariance_p * R.transpose();
}

}  // namespace plumbline::slam::mloam
