// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <span>
#include <vector>

#include "slam/registration/registration.h"

namespace plumbline::slam {

/// From start to start of a yaw_fan(), and what one start reaches.
constexpr double yaw_fan_turn_rad = 15.0 * std::numbers::pi / 180.0;

/// The same place, turned by up to 60 degrees either way.
[[nodiscard]] std::vector<Pose> yaw_fan(const Pose& X_MR);

/// For a level of the map whose voxels are this large: surfaces bend within a voxel, and the start is off by some of
/// it.
[[nodiscard]] RegistrationConfig coarser(RegistrationConfig config, double voxel_m);

/// The start, not none, that leads to the most matches in the coarser ones of these maps, which are finest first, and
/// where it leads.
[[nodiscard]] Registration align_coarsely(std::span<const Surfel> surfels, std::span<const SurfelMap> maps,
                                          const RegistrationConfig& config, std::span<const Pose> starts);

}  // namespace plumbline::slam
