// SPDX-License-Identifier: Apache-2.0
#include "bim/geometry/best_rotation.h"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace plumbline {

Eigen::Matrix3d best_rotation(const Eigen::Matrix3d& sum_qp) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum_qp, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0) signs.z() = -1.0;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

}  // namespace plumbline
