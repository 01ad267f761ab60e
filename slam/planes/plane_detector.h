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
  double flat_slope = 0.25;
  double gap_m = 0.25;
  double gap_per_m = 0.02;
  double segment_rms_m = 0.03;
  double step_chi2 = 20.0;
  double step_sigma_m = 0.004;
  int segment_points = 6;
  double segment_length_m = 0.15;
  double max_distance_m = 0.06;
  double max_turn_m = 0.03;
  double niche_m = 0.2;
  double max_tilt_prior_deg = 3.0;
  double merge_gap_m = 1.2;
  int min_points = 60;
  int min_rings = 3;
  double min_length_m = 0.5;
  double min_height_m = 0.2;
  double vertical_max_tilt_deg = 6.0;
  double floor_area_m2 = 0.5;
  double sigma_min_m = 0.01;
  double bias_floor_m = 0.01;
  double bias_floor_rad = 0.002;
  double bias_end_m = 0.01;
  double bias_floor_tilt_rad = 0.005;
  double laser_sigma_m = 0.0;

  template <class V>
  void visit(V& v) {
    v("min_range_m", min_range_m, Field{.doc = "least range of a return that is used", .min = 0.0});
    v("max_range_m", max_range_m, Field{.doc = "largest range of a return that is used", .min = 1.0});
    v("flat_slope", flat_slope,
      Field{.doc = "rise over run between neighbouring rings up to which a return is no wall",
            .unit = "m/m",
            .min = 0.0,
            .max = 1.0});
    v("gap_m", gap_m, Field{.doc = "jump between neighbouring returns of a ring that ends a segment", .min = 0.0});
    v("gap_per_m", gap_per_m,
      Field{.doc = "increase of this jump per metre of range, for grazing incidence", .unit = "m/m", .min = 0.0});
    // Walls show 12 to 17 mm.
    v("segment_rms_m", segment_rms_m, Field{.doc = "largest RMS of a segment around its line", .min = 0.001});
    v("step_chi2", step_chi2, plain_field("χ² gain of two lines over one at which a segment is split", {.min = 1.0}));
    // At grazing incidence, range noise runs along the line.
    v("step_sigma_m", step_sigma_m,
      Field{.doc = "least standard deviation across a line that this test assumes", .min = 1e-4});
    v("segment_points", segment_points, Field{.doc = "least number of returns of a segment", .min = 3});
    v("segment_length_m", segment_length_m, Field{.doc = "least length of a segment", .min = 0.0});
    // About 4 standard deviations of the range noise.
    v("max_distance_m", max_distance_m,
      Field{.doc = "largest distance of a point from the plane it joins", .min = 0.001});
    v("max_turn_m", max_turn_m,
      Field{.doc = "largest difference of the distances of a segment's two ends from the plane it joins",
            .min = 0.001});
    v("niche_m", niche_m,
      Field{.doc = "distance to a longer wall within which a wall turned out of it is dropped", .min = 0.0});
    v("max_tilt_prior_deg", max_tilt_prior_deg,
      Field{.doc = "standard deviation of a wall's tilt while few rings see it: gait and mounting", .min = 0.01});
    v("merge_gap_m", merge_gap_m,
      Field{.doc = "largest gap between coplanar segments of one patch: a wall goes on behind a door", .min = 0.0});
    v("min_points", min_points, Field{.doc = "least number of points of a patch", .min = 3});
    v("min_rings", min_rings,
      Field{.doc = "least number of rings of a patch; fewer do not fix a wall's tilt", .min = 2});
    v("min_length_m", min_length_m, Field{.doc = "least length of a wall patch", .min = 0.0});
    v("min_height_m", min_height_m, Field{.doc = "least height of a wall patch", .min = 0.0});
    v("vertical_max_tilt_deg", vertical_max_tilt_deg, Field{.doc = "largest tilt of a wall", .min = 0.0, .max = 45.0});
    v("floor_area_m2", floor_area_m2,
      Field{.doc = "least extent, length by width, of a floor or ceiling patch", .min = 0.0});
    v("sigma_min_m", sigma_min_m,
      Field{.doc = "least standard deviation of the range noise that is assumed", .min = 1e-4});
    v("bias_floor_m", bias_floor_m,
      Field{.doc = "error of a plane's distance that averaging cannot remove: range bias, deskewing", .min = 0.0});
    v("bias_floor_rad", bias_floor_rad,
      Field{.doc = "error of a wall's direction that averaging cannot remove: bias at grazing incidence", .min = 0.0});
    v("bias_end_m", bias_end_m,
      Field{.doc = "unevenness at one end of a patch, such as a frame or skirting, which turns it", .min = 0.0});
    v("bias_floor_tilt_rad", bias_floor_tilt_rad,
      Field{.doc = "error of a wall's tilt that averaging cannot remove: deskewing and mounting", .min = 0.0});
    // Few lasers observe a far wall, and its observations share them; 11 mm of a VLP-16, docs/methods/lidar_model.md.
    v("laser_sigma_m", laser_sigma_m,
      Field{.doc = "standard deviation of the lasers' range offsets against each other; 0: all alike", .min = 0.0});
  }
};

/// Walls, floor and ceiling of one scan, largest (most points) first, ties: lower centroid x, y. Walls: each ring is
/// cut into straight stretches, and stretches of different rings that lie in one upright plane make a wall. Floor and
/// ceiling: robust fit to the returns whose neighbours above and below are level with them.
[[nodiscard]] std::vector<PlaneObservation> detect_planes(const DeskewedScan& scan, const PlaneDetectorConfig& config);

}  // namespace plumbline::slam
