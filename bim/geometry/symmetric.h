// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace plumbline {

/// Eigenvalues of a symmetric N x N matrix in ascending order, and their unit eigenvectors as columns.
template <int N>
struct SymmetricEigen {
  Eigen::Matrix<double, N, 1> values;
  Eigen::Matrix<double, N, N> vectors;
};

/// Eigendecomposition of a symmetric matrix; only the lower triangle of A is read. Defined for N = 2, 3, 6 and
/// Eigen::Dynamic: Eigen's solvers are slow to compile, so each size is compiled once.
template <int N>
[[nodiscard]] SymmetricEigen<N> symmetric_eigen(const Eigen::Matrix<double, N, N>& A);

/// Solves A x = b by an LDLT decomposition; A is symmetric, positive or negative semidefinite, and only its lower
/// triangle is read. Defined for N = 3, 6 and Eigen::Dynamic.
template <int N>
[[nodiscard]] Eigen::Matrix<double, N, 1> solve_ldlt(const Eigen::Matrix<double, N, N>& A,
                                                     const Eigen::Matrix<double, N, 1>& b);

}  // namespace plumbline
