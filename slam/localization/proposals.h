// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/config/visit.h"
#include "slam/particles/particles.h"
#include "slam/plan_map/likelihood.h"

namespace plumbline::slam {

struct ProposalConfig {
  int walls = 5;                  ///< of a view, the largest, of which every two are tried
  double corner_min_sin = 0.5;    ///< of the angle between the two
  double angle_tolerance = 0.06;  ///< rad, between what is seen and planned
  double yaw_tolerance = 0.3;     ///< rad, from the told yaw
  int count = 96;                 ///< most places
  double gap_m = 0.3;             ///< between them
  double gap_rad = 0.35;

  template <class V>
  void visit(V& v) {
    v("walls", walls, Field{.doc = "of a view, the largest, of which every two are tried", .min = 0, .max = 32});
    v("corner_min_sin", corner_min_sin, Field{.doc = "of the angle between the two", .min = 0.01, .max = 1});
    v("angle_tolerance", angle_tolerance, Field{.doc = "rad, between what is seen and planned", .min = 0});
    v("yaw_tolerance", yaw_tolerance, Field{.doc = "rad, from the told yaw", .min = 0});
    v("count", count, Field{.doc = "most places", .min = 1, .max = 10000});
    v("gap_m", gap_m, Field{.doc = "between them", .min = 0});
    v("gap_rad", gap_rad, Field{.min = 0});
  }
};

struct Place {
  int storey = 0;
  Pose2 X_IH;
  bool exact = false;  ///< but for noise and the plan's tolerance; else as near as particles lie
};

/// Every place from which two of the walls seen are two walls of the plan, best first by the beams. Two walls that are
/// not parallel fix a pose, so none that looks the same is missed, as a sample of poses may miss it.
[[nodiscard]] std::vector<Place> propose_places(const PlanIndex& index, const StartBelief& belief, const View& view,
                                                int beam_stride, const LikelihoodConfig& likelihood,
                                                const ProposalConfig& config);

}  // namespace plumbline::slam
