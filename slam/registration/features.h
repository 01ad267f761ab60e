// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bim/config/visit.h"
#include "slam/scan/motion.h"

namespace plumbline::slam::loam {

/// [LOAM section V-A; limits of A-LOAM and F-LOAM: facts slam 5, 6]
struct FeatureConfig {
  double min_range_m = 0.5;
  double max_range_m = 60.0;
  int sectors = 6;                 ///< a ring is cut into so many, so that features spread over the scan
  int sharp = 2;                   ///< sharpest points of a sector
  int less_sharp = 20;             ///< sharpest points of a sector, the sharp ones included
  int flat = 4;                    ///< flattest points of a sector
  double edge_curvature_m2 = 0.1;  ///< |sum of the ways to the ten neighbours|^2 above which a point may be an edge
  double neighbour_gap_m = 0.22;   ///< picked points silence neighbours in a chain of steps shorter than this

  template <class V>
  void visit(V& v) {
    v("min_range_m", min_range_m, Field{.doc = "nearer returns are left out", .min = 0.0});
    v("max_range_m", max_range_m, Field{.doc = "farther returns are left out", .min = 1.0});
    v("sectors", sectors, Field{.doc = "parts of a ring that give features of their own", .min = 1, .max = 64});
    v("sharp", sharp, Field{.doc = "sharpest points of a sector", .min = 1});
    v("less_sharp", less_sharp, Field{.doc = "edge points of a sector", .min = 1});
    v("flat", flat, Field{.doc = "flattest points of a sector", .min = 1});
    v("edge_curvature_m2", edge_curvature_m2, Field{.doc = "least curvature of an edge", .min = 0.0});
    v("neighbour_gap_m", neighbour_gap_m, Field{.doc = "step that ends a neighbourhood", .min = 0.0});
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
/// with fewer than sectors * 11 returns gives none.
[[nodiscard]] Features find_features(const DeskewedScan& scan, const FeatureConfig& config);

/// Edge points alone: the less sharp ones of find_features(), but flat points silence none of them.
[[nodiscard]] std::vector<FeaturePoint> find_edges(const DeskewedScan& scan, const FeatureConfig& config);

/// The first one in each voxel of leaf_m, in their order, in R.
[[nodiscard]] std::vector<Eigen::Vector3d> first_of_each_leaf(const std::vector<FeaturePoint>& features, double leaf_m);

}  // namespace plumbline::slam::loam
