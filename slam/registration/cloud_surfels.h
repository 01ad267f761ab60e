// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "slam/registration/registration.h"

namespace plumbline::slam {

/// Registration of two clouds without rings or order, as files and other sensors give them.
struct CloudRegistrationConfig {
  double surfel_m = 0.3;
  int min_points = 8;
  double max_thickness = 0.35;
  double coarse_m = 1.0;
  int coarse_share = 4;
  double fine_m = 0.4;
  RegistrationConfig registration{
      .sigma_tangent_m = 0.1, .sigma_normal_m = 0.05, .translation_epsilon_m = 5e-4, .rotation_epsilon_rad = 5e-5};

  template <class V>
  void visit(V& v) {
    v("surfel_m", surfel_m, Field{.doc = "voxel size at which a cloud is thinned to one surfel each", .min = 0.01});
    v("min_points", min_points,
      Field{.doc = "least number of points in a surfel's voxel and the six around it", .min = 4});
    v("max_thickness", max_thickness,
      plain_field("largest thickness of a surfel, as a share of surfel_m", {.min = 0.01, .max = 1.0}));
    v("coarse_m", coarse_m, Field{.doc = "voxel size of the map in which clouds are first aligned", .min = 0.02});
    v("coarse_share", coarse_share, Field{.doc = "every how many surfels one is matched there", .min = 1});
    v("fine_m", fine_m, Field{.doc = "voxel size of the map in which clouds are finally matched", .min = 0.02});
    v("registration", registration);
  }
};

/// See cell_surfels().
[[nodiscard]] std::vector<Surfel> cloud_surfels(std::span<const Eigen::Vector3f> points,
                                                const CloudRegistrationConfig& config);

/// Pose X_TS of the source's frame in the target's, from `start`: a share of the surfels in coarse voxels, then all in
/// fine ones.
[[nodiscard]] Registration register_clouds(std::span<const Eigen::Vector3f> target_T,
                                           std::span<const Eigen::Vector3f> source_S, const Pose& start,
                                           const CloudRegistrationConfig& config);

}  // namespace plumbline::slam
