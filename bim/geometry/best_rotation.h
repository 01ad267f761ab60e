// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace plumbline {

/// The rotation R that minimises the sum of |q_i - R p_i|^2 over centred points, from the sum of q_i p_i^T
/// [umeyama1991]. Where the points leave a reflection as good, still a rotation.
[[nodiscard]] Eigen::Matrix3d best_rotation(const Eigen::Matrix3d& sum_qp);

}  // namespace plumbline
