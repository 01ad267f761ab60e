// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "bim/config/visit.h"
#include "slam/planes/plane_detector.h"

namespace plumbline::slam {

/// Whose RANSAC: ours, or pcl::SACSegmentation, which the papers' code calls.
enum class RansacSource { ours, pcl };
[[nodiscard]] constexpr std::array<std::string_view, 2> names_of(RansacSource) { return {"ours", "pcl"}; }

/// Defaults: those of the papers' code [lsg2022], but for the source.
struct RansacConfig {
  RansacSource source = RansacSource::ours;
  double min_range_m = 0.5;
  double max_range_m = 100.0;
  double voxel_m = 0.1;
  double distance_m = 0.01;
  int iterations = 500;
  double confidence = 0.99;
  int min_left = 100;
  int min_inliers = 100;
  int min_horizontal = 100;
  double cluster_gap_m = 0.2;
  int cluster_points = 50;
  double merge_gap_m = 2.0;

  template <class V>
  void visit(V& v) {
    v("source", source, Field{.doc = "whose RANSAC: ours, or SACSegmentation of PCL as in the papers' code"});
    v("min_range_m", min_range_m, Field{.doc = "least range of a return that is used", .min = 0});
    v("max_range_m", max_range_m, Field{.doc = "largest range of a return that is used", .min = 1});
    v("voxel_m", voxel_m, Field{.doc = "voxel size at which a scan is thinned to one return each", .min = 0.01});
    v("distance_m", distance_m, Field{.doc = "largest distance of an inlier from its plane", .min = 1e-3});
    v("iterations", iterations, Field{.doc = "most samples drawn for a plane", .min = 1});
    v("confidence", confidence,
      plain_field("probability of having drawn a clean sample at which sampling stops", {.min = 0.1, .max = 0.999999}));
    v("min_left", min_left, Field{.doc = "number of points left below which the search ends", .min = 3});
    v("min_inliers", min_inliers, Field{.doc = "least number of inliers of a wall", .min = 3});
    // With the 800 of 2022, a VLP-16 in a room sees no floor.
    v("min_horizontal", min_horizontal, Field{.doc = "least number of inliers of a floor or ceiling", .min = 3});
    v("cluster_gap_m", cluster_gap_m,
      Field{.doc = "gap between stretches of a plane that are cleaned separately", .min = 0.02});
    v("cluster_points", cluster_points, Field{.doc = "least number of points of a stretch that is kept", .min = 1});
    v("merge_gap_m", merge_gap_m,
      Field{.doc = "gap between cleaned stretches that become planes of their own", .min = 0.02});
  }
};

/// Planes of one scan by sequential RANSAC [bavle2023, section IV-B]: the plane with most returns within distance_m of
/// it is fitted, its inliers leave whether it is large enough or not, and the search goes on with the rest. Stretches
/// of one plane that lie apart are planes of their own. In the order found. No scan depends on another: draws of ours
/// are addressed by the scan's stamp and the method's seed, PCL begins anew at each plane.
[[nodiscard]] std::vector<PlaneObservation> ransac_planes(const DeskewedScan& scan, const RansacConfig& config,
                                                          const PlaneDetectorConfig& noise, std::uint64_t seed);

}  // namespace plumbline::slam
