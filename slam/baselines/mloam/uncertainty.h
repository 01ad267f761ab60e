// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "bim/geometry/pose.h"

namespace plumbline::slam::mloam {

/// Covariance in A of a point p_B that was measured with covariance_p, m^2, in a frame B whose pose has covariance_AB
/// (of increments on the left) [jiao2022].
[[nodiscard]] Eigen::Matrix3d point_covariance(const Pose& X_AB, const Matrix6d& covariance_AB,
                                               const Eigen::Vector3d& p_B, const Eigen::Matrix3d& covariance_p);

}  // namespace plumbline::slam::mloam
