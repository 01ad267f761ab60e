// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/cloud_surfels.h"

#include <optional>

#include "slam/registration/cell_surfels.h"

namespace plumbline::slam {

std::vector<Surfel> cloud_surfels(std::span<const Eigen::Vector3f> points, const CloudRegistrationConfig& config) {
  return cell_surfels(points,
                      {config.surfel_m, config.min_points, config.max_thickness * config.surfel_m, std::nullopt});
}

Registration register_clouds(std::span<const Eigen::Vector3f> target_T, std::span<const Eigen::Vector3f> source_S,
                             const Pose& start, const CloudRegistrationConfig& config) {
  const std::vector<Surfel> target = cloud_surfels(target_T, config);
  const std::vector<Surfel> source = cloud_surfels(source_S, config);
  std::vector<Surfel> few;
  for (std::size_t k = 0; k < source.size(); k += static_cast<std::size_t>(config.coarse_share))
    few.push_back(source[k]);
  RegistrationConfig rough = config.registration;
  // Near enough for the finer voxels.
  rough.translation_epsilon_m = 0.1 * config.fine_m;
  rough.rotation_epsilon_rad = 0.01 * config.fine_m;
  const auto match = [&](const std::vector<Surfel>& surfels, double voxel_m, const Pose& from,
                         const RegistrationConfig& how) {
    SurfelMap map(voxel_m);
    map.add(target, Pose{});
    return align(surfels, map, from, std::nullopt, how);
  };
  const Pose near = match(few, config.coarse_m, start, rough).X_MR;
  return match(source, config.fine_m, near, config.registration);
}

}  // namespace plumbline::slam
