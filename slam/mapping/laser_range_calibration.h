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

struct RangeOffsetConfig {
  bool correct = true;
  double unit_sigma_m = 0.03;    ///< of what all lasers' offsets have in common, beforehand [facts: lidar 2]
  double laser_sigma_m = 0.015;  ///< of what they have not
  double point_sigma_m = 0.03;   ///< of a return from its wall
  double inflation = 300.0;      ///< returns of one wall are not independent
  double gate_m = 0.09;          ///< of a return to its wall; at last half of it
  double clouds_m = 0.4;         ///< way between the scans that are looked at

  template <class V>
  void visit(V& v) {
    v("correct", correct, Field{.doc = "take the lasers' range offsets out of the map"});
    v("unit_sigma_m", unit_sigma_m, Field{.doc = "of the offset of all ranges, beforehand", .min = 1e-4});
    v("laser_sigma_m", laser_sigma_m, Field{.doc = "of a laser's ranges against the others'", .min = 1e-4});
    v("point_sigma_m", point_sigma_m, Field{.doc = "of a return from its wall", .min = 1e-3});
    v("inflation", inflation, Field{.doc = "of a return's variance", .min = 1});
    v("gate_m", gate_m, Field{.doc = "of a return to its wall", .min = 0.01});
    v("clouds_m", clouds_m, Field{.doc = "way between the scans that are looked at", .min = 0});
  }
};

/// How much too long each laser's ranges are, m, from the walls it hit. A range that is too long by b sets a return
/// back behind its wall by b times the cosine of the angle at which the ray meets it: by b head on, by less askew. What
/// a wall's returns have in common is where it stands; how they change with that cosine is the offset. Walls stand
/// upright, so that lasers that meet them higher up and lower down can be compared. Offsets that walls say little about
/// are held to zero. walls: faces in F, normals into free space; walls_config: which of them are one, as for
/// remove_reflections(). Empty where the clouds' lasers are not known.
[[nodiscard]] std::vector<double> range_offsets(std::span<const CloudKeyframe> clouds, std::span<const PlaneNode> walls,
                                                const Eigen::Vector3d& sensor_R, const RangeOffsetConfig& config,
                                                const ReflectionConfig& walls_config);

/// Shortens each range by its laser's offset.
void correct_ranges(std::vector<CloudKeyframe>& clouds, std::span<const double> offset_m,
                    const Eigen::Vector3d& sensor_R);

}  // namespace plumbline::slam
