// SPDX-License-Identifier: Apache-2.0
#include "slam/loam/degeneracy.h"

#include "bim/geometry/symmetric.h"

namespace plumbline::slam::loam {

GoodDirections good_directions(const Eigen::MatrixXd& normal, double least) {
  const auto eigen = symmetric_eigen(normal);
  GoodDirections result{Eigen::MatrixXd::Zero(normal.rows(), normal.cols()), 0};
  for (Eigen::Index k = 0; k < normal.rows(); ++k) {
    if (!(eigen.values[k] >= least)) {
      ++result.degenerate;
      continue;
    }
    const Eigen::VectorXd v = eigen.vectors.col(k);
    result.projection += v * v.transpose();
  }
  return result;
}

}  // namespace plumbline::slam::loam
