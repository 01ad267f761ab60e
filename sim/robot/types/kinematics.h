// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "sim/robot/types/dimensions.h"

namespace plumbline::sim {

/// Angles of one leg, rad: hx (abduction), hy (hip), kn (knee).
using LegAngles = Eigen::Vector3d;

/// Hip of a leg in R, m.
[[nodiscard]] Eigen::Vector3d hip_R(std::size_t leg);

/// Centre of the foot sphere in R, m; equations in docs/methods/robot.md.
[[nodiscard]] Eigen::Vector3d foot_R(std::size_t leg, const LegAngles& q);

/// Derivative of foot_R by the angles: rows x, y, z; columns hx, hy, kn.
[[nodiscard]] Eigen::Matrix3d foot_jacobian_R(std::size_t leg, const LegAngles& q);

/// Angles that put the foot's centre at p_R. Points out of reach give the nearest angles inside the joint ranges.
[[nodiscard]] LegAngles leg_angles(std::size_t leg, const Eigen::Vector3d& p_R);

}  // namespace plumbline::sim
