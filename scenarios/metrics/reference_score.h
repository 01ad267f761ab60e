// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "scenarios/metrics/trajectory.h"

namespace plumbline::scenarios::score {

/// Rules of the comparison with a reference.
struct ReferenceRules {
  double end_tolerance_s = 1e-4;  ///< beyond the ends of the estimate, whose end poses count there
  double most_intervals = 3.0;    ///< between two poses further apart, in median intervals, nothing is interpolated
  std::size_t least_matched = 3;  ///< two poses fit any two
  double rpe_distance_m = 1.0;
};

/// What a trajectory says by itself.
struct PathScore {
  std::size_t poses = 0;
  double duration_s = 0.0;
  double length_m = 0.0;               ///< from pose to pose
  std::optional<double> straightness;  ///< distance of its ends over its length; absent where it does not move
  double vertical_m = 0.0;             ///< between its highest and its lowest pose
};
[[nodiscard]] PathScore score_path(const std::vector<slam::StampedPose>& poses_F);

/// Errors of the motion from each pose of a reference to the next one.
struct StepErrors {
  double median_m = 0.0;
  double max_m = 0.0;
  double rotation_median_deg = 0.0;
  double rotation_max_deg = 0.0;
};

/// Poses beside those of a reference, of one robot and one frame of it.
struct ReferenceScore {
  std::size_t matched = 0;                    ///< reference poses
  double ate_aligned_rmse_m = 0.0;            ///< after the best rigid alignment
  std::optional<StepErrors> steps;            ///< absent where no two poses in a row match
  std::optional<double> rpe_1m_rmse_m;        ///< over each metre of the reference
  std::optional<double> rpe_1m_rotation_deg;  ///< mean

  /// Leaves what a reference of positions alone can tell.
  void drop_motion() { *this = {matched, ate_aligned_rmse_m, {}, {}, {}}; }
};

/// The estimate at each stamp of the reference, interpolated. Both must be in time order and not empty.
[[nodiscard]] std::vector<PosePair> match_reference(const std::vector<slam::StampedPose>& reference_W,
                                                    const std::vector<slam::StampedPose>& poses_F,
                                                    const ReferenceRules& rules = {});
/// Absent where fewer poses match than the rules want.
[[nodiscard]] std::optional<ReferenceScore> score_by_reference(const std::vector<slam::StampedPose>& reference_W,
                                                               const std::vector<slam::StampedPose>& poses_F,
                                                               const ReferenceRules& rules = {});

}  // namespace plumbline::scenarios::score
