// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/config/visit.h"
#include "bim/geometry/pose.h"
#include "slam/registration/features.h"

namespace plumbline::slam::loam {

struct ScanToScanConfig {
  double max_distance2_m2 = 25.0;  ///< squared distance to a match [A-LOAM: facts slam 6]
  int max_rings = 2;               ///< rings between the points that make a line or a plane
  double last_leaf_m = 0.2;        ///< the former scan's planar points are thinned to this
  double huber_m = 0.1;
  int rounds = 2;
  int iterations = 4;  ///< of one round of matches

  template <class V>
  void visit(V& v) {
    v("max_distance2_m2", max_distance2_m2, Field{.doc = "squared distance to a match", .min = 0.01});
    v("max_rings", max_rings, Field{.doc = "rings between points of one line or plane", .min = 1});
    v("last_leaf_m", last_leaf_m, Field{.doc = "voxel of the former scan's planar points", .min = 0.01});
    v("huber_m", huber_m, Field{.doc = "residual from which a feature counts linearly", .min = 1e-4});
    v("rounds", rounds, Field{.doc = "rounds of matching", .min = 1});
    v("iterations", iterations, Field{.doc = "of one round of matches", .min = 1});
  }
};

/// X_LR, this scan's pose in the former scan's frame L: sharp points onto lines through two edge points of the former
/// scan on different rings, flat points onto planes through three of its planar points [LOAM section V-B]. Starts at
/// X_LR; equal distances: the point found first.
[[nodiscard]] Pose align_scans(const Features& now, const Features& former, const Pose& X_LR,
                               const ScanToScanConfig& config);

}  // namespace plumbline::slam::loam
