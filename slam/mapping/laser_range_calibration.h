// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "bim/config/visit.h"
#include "slam/io/estimate.h"
#include "slam/mapping/mirror_ghosts.h"
#include "slam/scan/map_cloud.h"

namespace plumbline::slam {

struct LaserRangeCalibrationConfig {
  bool correct = true;
  double unit_sigma_m = 0.03;
  double laser_sigma_m = 0.015;
  double point_sigma_m = 0.03;
  double inflation = 300.0;
  double gate_m = 0.09;
  double clouds_m = 0.4;

  template <class V>
  void visit(V& v) {
    v("correct", correct,
      Field{.doc = "estimate the lasers' range offsets and remove them from the map", .basic = true});
    // docs/methods/lidar_model.md
    v("unit_sigma_m", unit_sigma_m,
      Field{.doc = "prior standard deviation of the offset that all lasers share", .min = 1e-4});
    v("laser_sigma_m", laser_sigma_m,
      Field{.doc = "prior standard deviation of one laser's offset against the others", .min = 1e-4});
    v("point_sigma_m", point_sigma_m,
      Field{.doc = "standard deviation of a return's distance from its wall", .min = 1e-3});
    v("inflation", inflation,
      plain_field("factor on a return's variance: returns of one wall are not independent", {.min = 1}));
    v("gate_m", gate_m,
      Field{.doc = "largest distance of a return from its wall; half of it in the last round", .min = 0.01});
    v("clouds_m", clouds_m, Field{.doc = "distance walked between the scans that are used", .min = 0});
  }
};

/// How much too long each laser's ranges are, m, from the walls it hit. A range that is too long by b sets a return
/// back behind its wall by b times the cosine of the angle at which the ray hits it: by b head on, by less askew. What
/// a wall's returns have in common is where it stands; how they change with that cosine is the offset. Walls stand
/// upright, so that lasers that hit them at different heights can be compared. Offsets that walls constrain little are
/// held at zero. walls: faces in F, normals into free space; walls_config: which of them are one, as for
/// remove_mirror_ghosts(). Empty where the clouds' lasers are not known.
[[nodiscard]] std::vector<double> calibrate_laser_ranges(std::span<const CloudKeyframe> clouds,
                                                         std::span<const PlaneNode> walls,
                                                         const Eigen::Vector3d& sensor_R,
                                                         const LaserRangeCalibrationConfig& config,
                                                         const MirrorGhostConfig& walls_config);

/// Shortens each range by its laser's offset.
void correct_ranges(std::vector<CloudKeyframe>& clouds, std::span<const double> offset_m,
                    const Eigen::Vector3d& sensor_R);

}  // namespace plumbline::slam
