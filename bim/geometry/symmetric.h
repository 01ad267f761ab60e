// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace plumbline {

/// Of a symmetric matrix: eigenvalues in ascending order, and unit eigenvectors as columns.
template <int N>
struct SymmetricEigen {
  Eigen::Matrix<double, N, 1> values;
  Eigen::Matrix<double, N, N> vectors;
};

/// For N = 2, 3, 6 and Eigen::Dynamic; only the lower triangle of A is read. These solvers are the dearest templates of
/// a build and are compiled once for each size.
template <int N>
[[nodiscard]] SymmetricEigen<N> symmetric_eigen(const Eigen::Matrix<double, N, N>& A);

/// x of A x = b by an LDLT decomposition; A is symmetric and positive or negative semidefinite. For N = 3, 6 and
/// Eigen::Dynamic.
template <int N>
[[nodiscard]] Eigen::Matrix<double, N, 1> solve_ldlt(const Eigen::Matrix<double, N, N>& A,
                                                     const Eigen::Matrix<double, N, 1>& b);

}  // namespace plumbline
