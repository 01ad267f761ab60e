// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

/// The rotation R that minimises the sum of |q_i - R p_i|^2 over centred points, from the sum of q_i p_i^T
/// [umeyama1991]. Where the points leave a reflection as good, still a rotation.
[[nodiscard]] Eigen::Matrix3d best_rotation(const Eigen::Matrix3d& sum_qp);

/// The least rotation that turns `from` towards `to`. Lengths do not count; neither may be zero.
[[nodiscard]] Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace plumbline
