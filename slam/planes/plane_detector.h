// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/config/visit.h"
#include "slam/scan/motion.h"
#include "slam/scan/plane_observation.h"

namespace plumbline::slam {

struct PlaneDetectorConfig {
  double min_range_m = 0.4;
  double max_range_m = 30.0;
  double flat_slope = 0.25;         ///< rise over run between neighbouring rings up to which a return is no wall
  double gap_m = 0.25;              ///< jump between neighbouring returns of a ring that ends a segment ...
  double gap_per_m = 0.02;          ///< ... plus this times the range (grazing incidence)
  double segment_rms_m = 0.03;      ///< of a ring's stretch around a line; walls show 12-17 mm [facts: lidar 2.5]
  double step_chi2 = 20.0;          ///< gain of two lines over one, in variances, at which a stretch is cut
  double step_sigma_m = 0.004;      ///< least noise across a line assumed there: aslant, range noise runs along it
  int segment_points = 6;           ///< fewest of a segment
  double segment_length_m = 0.15;   ///< shortest segment
  double max_distance_m = 0.06;     ///< gate of a point to the plane it joins; about 4 sigma of the range noise
  double max_turn_m = 0.03;         ///< gate of the distances of a segment's ends, one less the other: it runs along
  double niche_m = 0.2;             ///< a wall within this of a longer one that it is turned out of is no wall
  double max_tilt_prior_deg = 3.0;  ///< sigma of a wall's tilt in R while few rings are in: gait and mounting
  double merge_gap_m = 1.2;         ///< coplanar stretches this near are one patch: a wall goes on behind a door
  int min_points = 60;
  int min_rings = 3;          ///< fewer do not fix a wall's tilt
  double min_length_m = 0.5;  ///< of a wall patch
  double min_height_m = 0.2;  ///< of a wall patch
  double vertical_max_tilt_deg = 6.0;
  double floor_area_m2 = 0.5;     ///< smallest extent (length by width) of a floor or ceiling patch
  double sigma_min_m = 0.01;      ///< least range noise assumed
  double bias_floor_m = 0.01;     ///< what averaging cannot remove: range bias of a unit, deskew [facts: lidar 2.2]
  double bias_floor_rad = 0.002;  ///< the same for the turn of a wall: a bias b bends what is seen aslant ...
  double bias_end_m = 0.01;  ///< ... and a frame or skirting this thick at one end turns it by this over its length
  double bias_floor_tilt_rad = 0.005;  ///< and for its tilt: deskew and mounting
  /// Sigma of the lasers' range offsets against each other, of which few speak of a far wall and no look tells anew
  /// (11 mm of a VLP-16 [facts: lidar 2.5]); 0: alike.
  double laser_sigma_m = 0.0;

  template <class V>
  void visit(V& v) {
    v("min_range_m", min_range_m, Field{.min = 0.0});
    v("max_range_m", max_range_m, Field{.min = 1.0});
    v("flat_slope", flat_slope, Field{.min = 0.0, .max = 1.0});
    v("gap_m", gap_m, Field{.min = 0.0});
    v("gap_per_m", gap_per_m, Field{.min = 0.0});
    v("segment_rms_m", segment_rms_m, Field{.min = 0.001});
    v("step_chi2", step_chi2, Field{.doc = "gain of two lines over one at which a stretch is cut", .min = 1.0});
    v("step_sigma_m", step_sigma_m, Field{.doc = "least noise across a line assumed there", .min = 1e-4});
    v("segment_points", segment_points, Field{.min = 3});
    v("segment_length_m", segment_length_m, Field{.min = 0.0});
    v("max_distance_m", max_distance_m, Field{.min = 0.001});
    v("max_turn_m", max_turn_m, Field{.doc = "of a segment out of the plane it joins, over its length", .min = 0.001});
    v("niche_m", niche_m, Field{.doc = "of a longer wall within which one turned out of it is none", .min = 0.0});
    v("max_tilt_prior_deg", max_tilt_prior_deg, Field{.min = 0.01});
    v("merge_gap_m", merge_gap_m, Field{.min = 0.0});
    v("min_points", min_points, Field{.min = 3});
    v("min_rings", min_rings, Field{.min = 2});
    v("min_length_m", min_length_m, Field{.min = 0.0});
    v("min_height_m", min_height_m, Field{.min = 0.0});
    v("vertical_max_tilt_deg", vertical_max_tilt_deg, Field{.min = 0.0, .max = 45.0});
    v("floor_area_m2", floor_area_m2, Field{.min = 0.0});
    v("sigma_min_m", sigma_min_m, Field{.min = 1e-4});
    v("bias_floor_m", bias_floor_m, Field{.min = 0.0});
    v("bias_floor_rad", bias_floor_rad, Field{.min = 0.0});
    v("bias_end_m", bias_end_m, Field{.doc = "unevenness at one end of a patch, which turns it", .min = 0.0});
    v("bias_floor_tilt_rad", bias_floor_tilt_rad, Field{.min = 0.0});
    v("laser_sigma_m", laser_sigma_m, Field{.doc = "of the lasers' range offsets against each other", .min = 0.0});
  }
};

/// Walls, floor and ceiling of one scan, largest (most points) first, ties: lower centroid x, y. Walls: each ring is
/// cut into straight stretches, and stretches of different rings that lie in one upright plane make a wall. Floor and
/// ceiling: robust fit to the returns whose neighbours above and below are level with them.
[[nodiscard]] std::vector<PlaneObservation> detect_planes(const DeskewedScan& scan, const PlaneDetectorConfig& config);

}  // namespace plumbline::slam
