// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "bim/config/visit.h"
#include "bim/geometry/pose.h"
#include "slam/io/records.h"
#include "slam/loam/keyframe_map.h"

namespace plumbline::slam::lego {

struct LoopConfig {
  bool on = false;
  double radius_m = 7.0;
  double least_s = 30.0;
  int neighbours = 25;
  double leaf_m = 0.4;
  double reach_m = 100.0;
  int iterations = 100;
  double fitness_m2 = 0.3;

  template <class V>
  void visit(V& v) {
    v("on", on, Field{.doc = "close loops; off, as in the reference", .basic = true});
    v("radius_m", radius_m, Field{.doc = "largest distance of the old keyframe", .min = 0.0, .basic = true});
    v("least_s", least_s, Field{.doc = "least time since it", .min = 0.0});
    v("neighbours", neighbours, Field{.doc = "keyframes on each side of it that are matched with, too", .min = 0});
    v("leaf_m", leaf_m, Field{.doc = "voxel size of these", .min = 0.02});
    v("reach_m", reach_m, Field{.doc = "largest distance of a point's correspondence", .min = 0.01});
    v("iterations", iterations, Field{.doc = "most iterations of ICP", .min = 1, .max = 10000});
    v("fitness_m2", fitness_m2,
      Field{.doc = "largest mean squared distance between the clouds of a loop closure", .min = 0.0});
  }
};

struct IcpResult {
  Pose X_TS;
  double fitness_m2 = 0.0;  ///< mean squared distance of S's points to their nearest of T's
};

/// Point-to-point ICP from the guess [besl1992]. Neither cloud may be empty.
[[nodiscard]] IcpResult icp(const std::vector<Eigen::Vector3d>& points_T, const std::vector<Eigen::Vector3d>& points_S,
                            const Pose& guess, const LoopConfig& config);

struct Loop {
  std::size_t keyframe = 0;
  Pose X_FT;  ///< measured pose of the last keyframe in this one
  double fitness_m2 = 0.0;
};

/// The last keyframe against the nearest one that is old enough, with its neighbours. stamps: of the map's keyframes.
[[nodiscard]] std::optional<Loop> find_loop(const loam::KeyframeMap& map, const std::vector<Nanoseconds>& stamps,
                                            const LoopConfig& config);

}  // namespace plumbline::slam::lego
