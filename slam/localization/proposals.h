// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/config/visit.h"
#include "slam/particles/particles.h"
#include "slam/plan_map/likelihood.h"

namespace plumbline::slam {

struct ProposalConfig {
  int walls = 5;
  double corner_min_sin = 0.5;
  double angle_tolerance = 0.06;
  double yaw_tolerance = 0.3;
  int count = 96;
  double gap_m = 0.3;
  double gap_rad = 0.35;
  double slide_m = 30.0;
  double slide_step_m = 0.5;
  int slide_count = 64;

  template <class V>
  void visit(V& v) {
    v("walls", walls, Field{.doc = "largest walls of a scan of which every pair is tried", .min = 0, .max = 32});
    v("corner_min_sin", corner_min_sin,
      plain_field("least sine of the angle between the two walls", {.min = 0.01, .max = 1}));
    v("angle_tolerance", angle_tolerance,
      Field{.doc = "largest difference between the observed and the planned corner angle", .unit = "rad", .min = 0});
    v("yaw_tolerance", yaw_tolerance, Field{.doc = "largest difference from the prior yaw", .unit = "rad", .min = 0});
    v("count", count,
      Field{.doc = "most poses that are proposed by walls, and by rows of furniture", .min = 1, .max = 10000});
    v("gap_m", gap_m, Field{.doc = "least distance between two proposed poses", .min = 0});
    v("gap_rad", gap_rad, Field{.doc = "or least angle between two proposed poses", .min = 0});
    // Half the length of a large hall.
    v("slide_m", slide_m,
      Field{.doc = "farthest that the leading pose is moved across a wall observed from it", .min = 0, .max = 200});
    v("slide_step_m", slide_step_m, Field{.doc = "distance between these places", .min = 0.05});
    v("slide_count", slide_count,
      Field{.doc = "most of them that are proposed for each direction", .min = 0, .max = 1000});
  }
};

struct StoreyPose {
  int storey = 0;
  Pose2 X_IH;
  bool exact = false;  ///< exact up to noise and the plan's tolerance; else as near as particles are spaced
};

struct ScoredPose {
  StoreyPose pose;
  double score = 0.0;
};

/// At most `count` poses of the highest scores, no two of them near each other; ties: the first in `poses`.
[[nodiscard]] std::vector<StoreyPose> non_max_suppression(std::vector<ScoredPose> poses, int count, double gap_m,
                                                          double gap_rad);

/// Every pose from which two of the observed walls are two walls of the plan, best first by the beams. Two walls that
/// are not parallel fix a pose, so that no aliased pose is missed, which a random sample might do. Then those by rows
/// of planned furniture: between shelves a scan may show hardly any wall.
[[nodiscard]] std::vector<StoreyPose> propose_poses(const PlanIndex& index, const StartPrior& prior,
                                                    const LocalizationScan& scan, int beam_stride,
                                                    const LikelihoodConfig& likelihood, const ProposalConfig& config);

/// The pose moved across the largest walls observed from it, for each direction best first by the beams: what was taken
/// for a wall may be the front of a row of furniture, which alone puts the pose where it is.
[[nodiscard]] std::vector<std::vector<StoreyPose>> slide_across_walls(const PlanIndex& index, const StoreyPose& pose,
                                                                      const LocalizationScan& scan, int beam_stride,
                                                                      const LikelihoodConfig& likelihood,
                                                                      const ProposalConfig& config);

}  // namespace plumbline::slam
