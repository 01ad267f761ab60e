// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/config/visit.h"
#include "bim/geometry/pose.h"
#include "slam/registration/features.h"

namespace plumbline::slam::loam {

struct ScanToScanConfig {
  double max_distance2_m2 = 25.0;
  int max_rings = 2;
  double last_leaf_m = 0.2;
  double huber_m = 0.1;
  int rounds = 2;
  int iterations = 4;

  template <class V>
  void visit(V& v) {
    // [qin2018]
    v("max_distance2_m2", max_distance2_m2, Field{.doc = "largest squared distance to a match", .min = 0.01});
    v("max_rings", max_rings, Field{.doc = "most rings between the points that make a line or a plane", .min = 1});
    v("last_leaf_m", last_leaf_m,
      Field{.doc = "voxel size at which the previous scan's planar points are thinned", .min = 0.01});
    v("huber_m", huber_m, Field{.doc = "residual above which a feature counts linearly (Huber)", .min = 1e-4});
    v("rounds", rounds, Field{.doc = "rounds of matching against the previous scan", .min = 1, .basic = true});
    v("iterations", iterations, Field{.doc = "solver iterations of one round of matching", .min = 1});
  }
};

/// X_LR, this scan's pose in the former scan's frame L: sharp points onto lines through two edge points of the former
/// scan on different rings, flat points onto planes through three of its planar points [zhang2014, section V-B]. Starts
/// at X_LR; equal distances: the point found first.
[[nodiscard]] Pose align_scans(const Features& now, const Features& former, const Pose& X_LR,
                               const ScanToScanConfig& config);

}  // namespace plumbline::slam::loam
