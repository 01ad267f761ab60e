// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "slam/registration/point_map.h"
#include "slam/registration/registration.h"

namespace plumbline::slam::loam {

/// A feature of R tied to a line or plane of F (M or the former scan): its residual is across * (X_FR p_R - anchor_F).
struct Match {
  Eigen::Vector3d p_R;
  Eigen::Vector3d anchor_F;
  Eigen::Matrix3d across;  ///< projection: I - d d^T of a line along d, n n^T of a plane
};

/// Nothing when the points do not make a line or plane.
[[nodiscard]] std::optional<Match> line_match(const Eigen::Vector3d& p_R, const Eigen::Vector3d& a_F,
                                              const Eigen::Vector3d& b_F);
[[nodiscard]] std::optional<Match> plane_match(const Eigen::Vector3d& p_R, const Eigen::Vector3d& a_F,
                                               const Eigen::Vector3d& b_F, const Eigen::Vector3d& c_F);

/// To the line through map points when the largest eigenvalue of their scatter is more than line_ratio times the second
/// [wang2021].
[[nodiscard]] std::optional<Match> line_match(const Eigen::Vector3d& p_R, const PointMap::Neighbours& points_F,
                                              double line_ratio);
/// To their plane when none is farther from it than tolerance_m and the second eigenvalue is more than plane_ratio
/// times the smallest.
[[nodiscard]] std::optional<Match> plane_match(const Eigen::Vector3d& p_R, const PointMap::Neighbours& points_F,
                                               double plane_ratio, double tolerance_m);

/// Normal equations of all residuals under a Huber kernel, by the right increment of X_FR.
[[nodiscard]] Normal6 linearize(std::span<const Match> matches, const Pose& X_FR, double huber_m);

}  // namespace plumbline::slam::loam
