// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/config/visit.h"
#include "slam/baselines/lego_loam/range_image.h"

namespace plumbline::slam::lego {

struct FeatureConfig {
  int sectors = 6;
  int sharp = 2;
  int less_sharp = 20;
  int flat = 4;
  double curvature_m2 = 0.1;
  double less_flat_leaf_m = 0.2;

  template <class V>
  void visit(V& v) {
    v("sectors", sectors, Field{.doc = "parts of a ring, each with its own features", .min = 1, .max = 64});
    v("sharp", sharp, Field{.doc = "sharpest points of a part that are matched from scan to scan", .min = 1});
    v("less_sharp", less_sharp, Field{.doc = "sharpest points of a part that enter the map", .min = 1});
    v("flat", flat, Field{.doc = "flattest ground points of a part", .min = 1});
    v("curvature_m2", curvature_m2,
      Field{.doc = "squared sum of ten ranges less ten times the point's, that parts edges from flats", .min = 0.0});
    v("less_flat_leaf_m", less_flat_leaf_m,
      Field{.doc = "voxel size at which a ring's points that are no edges are thinned", .min = 0.01});
  }
};

struct Features {
  std::vector<ImagePoint> sharp;       ///< no ground
  std::vector<ImagePoint> less_sharp;  ///< with the sharp ones
  std::vector<ImagePoint> flat;        ///< ground alone
  std::vector<ImagePoint> less_flat;   ///< everything that is no edge, the first of each voxel
};

/// Features by the curvature of ranges along what segmentation left of each ring.
[[nodiscard]] Features find_features(const SegmentedCloud& cloud, const FeatureConfig& config);

}  // namespace plumbline::slam::lego
