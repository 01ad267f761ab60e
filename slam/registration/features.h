// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bim/config/visit.h"
#include "slam/scan/motion.h"

namespace plumbline::slam::loam {

/// [zhang2014, section V-A], with the limits of [qin2018] and [wang2021].
struct FeatureConfig {
  double min_range_m = 0.5;
  double max_range_m = 60.0;
  int sectors = 6;
  int sharp = 2;
  int less_sharp = 20;
  int flat = 4;
  double edge_curvature_m2 = 0.1;
  double neighbour_gap_m = 0.22;

  template <class V>
  void visit(V& v) {
    v("min_range_m", min_range_m, Field{.doc = "least range of a return that is used", .min = 0.0});
    v("max_range_m", max_range_m, Field{.doc = "largest range of a return that is used", .min = 1.0, .basic = true});
    v("sectors", sectors,
      Field{.doc = "sectors of a ring, each with its own features, so that they spread over the scan",
            .min = 1,
            .max = 64});
    v("sharp", sharp, Field{.doc = "sharpest points of a sector that are matched from scan to scan", .min = 1});
    v("less_sharp", less_sharp, Field{.doc = "sharpest points of a sector that enter the map", .min = 1});
    v("flat", flat, Field{.doc = "flattest points of a sector", .min = 1});
    v("edge_curvature_m2", edge_curvature_m2,
      Field{.doc = "least curvature of an edge point: squared norm of the sum of vectors to ten neighbours",
            .min = 0.0});
    v("neighbour_gap_m", neighbour_gap_m,
      Field{.doc = "step between returns that ends the neighbourhood a picked point suppresses", .min = 0.0});
  }
};

struct FeaturePoint {
  Eigen::Vector3d p_R;
  int ring = 0;
};

/// Features of a scan, ring by ring, sector by sector, each in the order in which it was picked.
struct Features {
  std::vector<FeaturePoint> sharp;
  std::vector<FeaturePoint> less_sharp;
  std::vector<FeaturePoint> flat;
  std::vector<FeaturePoint> less_flat;  ///< everything that is no edge
};

/// Edge and planar points by the curvature of the ring they lie on. Equal curvatures: the earlier column first. A ring
/// with fewer than sectors * 11 returns gives none, nor does a scan of fewer than four rings.
[[nodiscard]] Features find_features(const DeskewedScan& scan, const FeatureConfig& config);

/// Edge points alone: the less sharp ones of find_features(), but flat points silence none of them, and what is no
/// sharper than the scan's range noise is left out. So are ends of surfaces as far as the LiDAR reaches, and borders of
/// shadows. What casts one ends on average half a step between returns beyond its last one: there the edge is.
[[nodiscard]] std::vector<FeaturePoint> find_edges(const DeskewedScan& scan, const FeatureConfig& config);

/// The first one in each voxel of leaf_m, in their order, in R.
[[nodiscard]] std::vector<Eigen::Vector3d> first_of_each_leaf(const std::vector<FeaturePoint>& features, double leaf_m);

}  // namespace plumbline::slam::loam
