// SPDX-License-Identifier: Apache-2.0
#include "bim/geometry/symmetric.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace plumbline {

template <int N>
SymmetricEigen<N> symmetric_eigen(const Eigen::Matrix<double, N, N>& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

template <int N>
Eigen::Matrix<double, N, 1> solve_ldlt(const Eigen::Matrix<double, N, N>& A, const Eigen::Matrix<double, N, 1>& b) {
  return A.ldlt().solve(b);
}

template SymmetricEigen<2> symmetric_eigen(const Eigen::Matrix2d&);
template SymmetricEigen<3> symmetric_eigen(const Eigen::Matrix3d&);
template SymmetricEigen<6> symmetric_eigen(const Eigen::Matrix<double, 6, 6>&);
template SymmetricEigen<Eigen::Dynamic> symmetric_eigen(const Eigen::MatrixXd&);
template Eigen::Vector3d solve_ldlt(const Eigen::Matrix3d&, const Eigen::Vector3d&);
template Eigen::Matrix<double, 6, 1> solve_ldlt(const Eigen::Matrix<double, 6, 6>&, const Eigen::Matrix<double, 6, 1>&);
template Eigen::VectorXd solve_ldlt(const Eigen::MatrixXd&, const Eigen::VectorXd&);

}  // namespace plumbline
