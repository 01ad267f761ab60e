// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/coarse_search.h"

#include <algorithm>
#include <optional>

namespace plumbline::slam {

std::vector<Pose> yaw_fan(const Pose& X_MR) {
  constexpr int turns = 4;
  std::vector<Pose> fan;
  for (int k = -turns; k <= turns; ++k)
    fan.push_back(X_MR * Pose::from_xyz_yaw(Eigen::Vector3d::Zero(), k * yaw_fan_turn_rad));
  return fan;
}

RegistrationConfig coarser(RegistrationConfig config, double voxel_m) {
  config.sigma_tangent_m = voxel_m;
  config.sigma_normal_m = std::max(config.sigma_normal_m, 0.2 * voxel_m);
  config.min_normal_agreement = std::min(config.min_normal_agreement, 0.7);
  config.max_iterations *= 2;
  config.translation_epsilon_m = 0.02 * voxel_m;
  config.rotation_epsilon_rad = 0.002 * voxel_m;
  config.least_eigenvalue = 0.0;
  return config;
}

Registration align_coarsely(std::span<const Surfel> surfels, std::span<const SurfelMap> maps,
                            const RegistrationConfig& config, std::span<const Pose> starts) {
  Registration best;
  best.X_MR = starts.front();
  best.matched = -1.0;
  for (const Pose& start : starts) {
    Registration found;
    found.X_MR = start;
    for (std::size_t level = maps.size(); level-- > 1;)
      found = align(surfels, maps[level], found.X_MR, std::nullopt, coarser(config, maps[level].voxel_m()));
    if (found.matched > best.matched) best = found;
  }
  return best;
}

}  // namespace plumbline::slam
