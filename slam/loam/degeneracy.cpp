// SPDX-License-Identifier: Apache-2.0
#include "slam/loam/degeneracy.h"

#include <Eigen/Eigenvalues>

namespace plumbline::slam::loam {

GoodDirections good_directions(const Eigen::MatrixXd& normal, double least) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(normal);
  GoodDirections result{Eigen::MatrixXd::Zero(normal.rows(), normal.cols()), 0};
  for (Eigen::Index k = 0; k < normal.rows(); ++k) {
    if (!(solver.eigenvalues()[k] >= least)) {
      ++result.degenerate;
      continue;
    }
    const Eigen::VectorXd v = solver.eigenvectors().col(k);
    result.projection += v * v.transpose();
  }
  return result;
}

}  // namespace plumbline::slam::loam
