// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "bim/geometry/pose.h"
#include "slam/registration/registration.h"
#include "slam/registration/surfels.h"

namespace plumbline::slam {

/// The translation that the fewest of the surfels facing it agree on.
struct LeastSupported {
  Eigen::Vector3d direction_R = Eigen::Vector3d::UnitX();  ///< unit vector
  /// Share of those surfels that meet the map, by that of the surfels facing the best supported direction; 0 to 1. It
  /// is 1 where hardly any surfel faces the direction, which is degenerate then.
  double share = 1.0;
};
/// At X_MR, where a registration led whose inliers have this residual (m): a surfel meets the map within three times
/// of it. Where faces move, as those of a crowd or of traffic, registration finds a pose that some of them agree on.
[[nodiscard]] LeastSupported least_supported(std::span<const Surfel> surfels, const SurfelMap& map, const Pose& X_MR,
                                             const RegistrationConfig& config, double residual_m);

/// The translation (unit vector of R) that odometry must tell, where `found` is led by what moves: few of the surfels
/// that face it meet the map; or, among_movers, not many and `found` is off from `expected` by more than odometry's
/// sigma_m explains. Without movers such an odometry slips.
[[nodiscard]] std::optional<Eigen::Vector3d> moving_direction(std::span<const Surfel> surfels, const SurfelMap& map,
                                                              const Registration& found, const Pose& expected,
                                                              double sigma_m, const RegistrationConfig& config,
                                                              bool among_movers);

}  // namespace plumbline::slam
