// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "bim/config/visit.h"
#include "slam/planes/plane_detector.h"

namespace plumbline::slam {

/// Defaults: those of the papers' code [facts: slam 2.2].
struct RansacConfig {
  double min_range_m = 0.5;
  double max_range_m = 100.0;
  double voxel_m = 0.1;  ///< one return a voxel is kept
  double distance_m = 0.01;
  int iterations = 500;
  double confidence = 0.99;    ///< of having met a clean sample, at which sampling stops
  int min_left = 100;          ///< fewer points left end the search
  int min_inliers = 100;       ///< of a wall
  int min_horizontal = 100;    ///< of a horizontal plane; with the 800 of 2022 a VLP-16 in a room sees no floor
  double cluster_gap_m = 0.2;  ///< cleaning: stretches farther apart are looked at alone ...
  int cluster_points = 50;     ///< ... and dropped when smaller
  double merge_gap_m = 2.0;    ///< what is left and farther apart than this are planes of their own

  template <class V>
  void visit(V& v) {
    v("min_range_m", min_range_m, Field{.min = 0});
    v("max_range_m", max_range_m, Field{.min = 1});
    v("voxel_m", voxel_m, Field{.doc = "one return a voxel", .min = 0.01});
    v("distance_m", distance_m, Field{.doc = "of an inlier", .min = 1e-3});
    v("iterations", iterations, Field{.doc = "samples a plane, at most", .min = 1});
    v("confidence", confidence, Field{.doc = "of a clean sample, ends sampling", .min = 0.1, .max = 0.999999});
    v("min_left", min_left, Field{.doc = "fewer points left end the search", .min = 3});
    v("min_inliers", min_inliers, Field{.doc = "of a wall", .min = 3});
    v("min_horizontal", min_horizontal, Field{.doc = "inliers of a floor or ceiling", .min = 3});
    v("cluster_gap_m", cluster_gap_m, Field{.doc = "apart: a stretch of its own while cleaning", .min = 0.02});
    v("cluster_points", cluster_points, Field{.doc = "of a stretch that is kept", .min = 1});
    v("merge_gap_m", merge_gap_m, Field{.doc = "apart: a plane of its own", .min = 0.02});
  }
};

/// Planes of one scan by sequential RANSAC [S-Graphs+ section IV-B]: the plane with most returns within distance_m of
/// it is fitted, its inliers leave whether it is large enough or not, and the search goes on with the rest. Stretches
/// of one plane that lie apart are planes of their own. In the order found. Draws are addressed by the scan's stamp, so
/// that no scan depends on another; seed: the method's.
[[nodiscard]] std::vector<PlaneObservation> ransac_planes(const DeskewedScan& scan, const RansacConfig& config,
                                                          const PlaneDetectorConfig& noise, std::uint64_t seed);

}  // namespace plumbline::slam
