// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "bim/config/visit.h"
#include "slam/baselines/hdl_slam_paper/cloud_matcher.h"

namespace plumbline::slam::hdl {

/// Values of hdl_graph_slam's indoor launch file.
struct LoopDetectorConfig {
  bool on = true;
  double distance_m = 1.0;
  double walked_m = 3.0;
  double since_last_m = 1.0;
  double fitness_m2 = 0.5;

  template <class V>
  void visit(V& v) {
    v("on", on, Field{.doc = "close loops", .basic = true});
    v("distance_m", distance_m,
      Field{.doc = "largest horizontal distance of a candidate from the new keyframe", .min = 0.0, .basic = true});
    v("walked_m", walked_m, Field{.doc = "least distance walked between the two", .min = 0.0});
    v("since_last_m", since_last_m, Field{.doc = "least distance walked since the last loop closure", .min = 0.0});
    v("fitness_m2", fitness_m2,
      Field{.doc = "largest mean squared distance between the two clouds of a loop closure", .min = 0.0});
  }
};

/// A keyframe as loops see it.
struct LoopKeyframe {
  Pose X_MR;
  double walked_m = 0.0;
  const std::vector<Eigen::Vector3d>* points_R = nullptr;
};

/// Indices of the keyframes that the last one may be matched with. Heights do not count, as in the reference: keyframes
/// of other storeys are candidates.
[[nodiscard]] std::vector<std::size_t> loop_candidates(const std::vector<LoopKeyframe>& keyframes, double last_loop_m,
                                                       const LoopDetectorConfig& config);

struct HdlLoop {
  std::size_t keyframe = 0;
  Pose X_FT;  ///< measured pose of the last keyframe in this one
  double fitness_m2 = 0.0;
};

/// The candidate that fits best, if it fits.
[[nodiscard]] std::optional<HdlLoop> detect_loop(const std::vector<LoopKeyframe>& keyframes, double last_loop_m,
                                                 const LoopDetectorConfig& config, CloudMatcher& matcher);

}  // namespace plumbline::slam::hdl
