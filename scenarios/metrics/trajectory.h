// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "slam/io/estimate.h"

namespace plumbline::scenarios::score {

/// Rules of the trajectory metrics, docs/reference/metrics.md.
struct TrajectoryRules {
  double max_stamp_difference_s = 0.01;  ///< of a scan and the pose given for it
  double min_coverage = 0.95;            ///< share of scans with a pose; below, a method is lost
  double rpe_distance_m = 1.0;           ///< walked between the two ends of a relative error
  double drift_distance_m = 10.0;        ///< walked between the two ends of a stretch whose drift is taken
  /// An error beyond half of a door of 1 m is far off: such a pose stands in the jamb while the robot is in the middle
  /// of the door, or behind a wall. The answer of a localization counts as wrong from there, too.
  double far_off_m = 0.5;
};

/// True poses X_WR in time order, 100 Hz and at every scan, and the stamps of the scans.
struct Truth {
  std::vector<slam::StampedPose> poses_W;
  std::vector<slam::Nanoseconds> scans;
  std::optional<slam::Nanoseconds> set_down = {};  ///< first scan of a robot that was kidnapped, where it was

  /// What was before the robot was kidnapped; all where it was not.
  [[nodiscard]] Truth before() const;
  /// X_WR at t, interpolated between neighbours; the first or last pose outside.
  [[nodiscard]] Pose at(slam::Nanoseconds t) const;
  /// Horizontal distance walked from the first scan to each scan, m. Sampled at the scans, so that the sway of the
  /// gait between them does not count; nor does the way it was carried.
  [[nodiscard]] std::vector<double> walked() const;
};

/// The pose given for one scan, beside the true pose at the same time.
struct PosePair {
  std::size_t scan = 0;  ///< index into Truth::scans
  Pose X_FR;
  Pose X_WR;
};

/// For each scan the nearest pose in time within the rule (ties: the earlier). Poses must be in time order.
[[nodiscard]] std::vector<PosePair> associate(const Truth& truth, const std::vector<slam::StampedPose>& poses_F,
                                              const TrajectoryRules& rules);

/// X_WF of the rigid motion (no scale) that brings the positions in F closest to those in W in the least-squares
/// sense [umeyama1991]. At least one pair; where positions leave rotations free (a single
/// point, a straight line), some minimiser.
[[nodiscard]] Pose umeyama(const std::vector<PosePair>& pairs);
/// X_WF as umeyama(), for what is placed beside the trajectory, as maps and rooms are: where the positions lie along a
/// line they leave the rotation about it free, and where they lie in one place all rotations; attitudes fix these.
[[nodiscard]] Pose place_map(const std::vector<PosePair>& pairs);
/// X_WF by the first pair alone.
[[nodiscard]] Pose place_by_first(const std::vector<PosePair>& pairs);

/// Root mean square of the position error |X_WF p_F - p_W|, m. Throws InternalError on no pairs.
[[nodiscard]] double position_rmse(const std::vector<PosePair>& pairs, const Pose& X_WF);
/// The error of the motion from pair `a` to pair `b`, in the frame of b's true pose.
[[nodiscard]] Pose motion_error(const PosePair& a, const PosePair& b);

/// Relative errors over every stretch of one length.
struct RelativeErrors {
  double translation_rmse_m = 0.0;
  double translation_mean_m = 0.0;
  double rotation_mean_rad = 0.0;
};

/// Of every stretch of `distance_m` walked; absent when the walk is shorter.
[[nodiscard]] std::optional<RelativeErrors> relative_errors(const std::vector<PosePair>& pairs, const Truth& truth,
                                                            double distance_m);
/// The same where `walked` is the distance at each index that PosePair::scan may be, m, ascending.
[[nodiscard]] std::optional<RelativeErrors> relative_errors(const std::vector<PosePair>& pairs,
                                                            const std::vector<double>& walked, double distance_m);

/// Error of the motion, m, over the last `distance_m` walked before each pair; absent at the first ones.
[[nodiscard]] std::vector<std::optional<double>> errors_over(const std::vector<PosePair>& pairs,
                                                             const std::vector<double>& walked, double distance_m);

/// What the SLAM trajectory metrics say of one method.
struct TrajectoryScore {
  double coverage = 0.0;  ///< share of scans with a pose
  double ate_rmse_m = 0.0;
  double ate_aligned_rmse_m = 0.0;
  std::optional<double> ate_final_rmse_m;  ///< absent where too few scans have a final pose
  std::optional<double> rpe_1m_rmse_m;
  std::optional<double> drift_10m_percent;    ///< mean error of translation over 10 m walked
  std::optional<double> drift_10m_deg_per_m;  ///< mean error of rotation over 10 m walked
  Pose X_WF_final;                            ///< place_map() of the final trajectory: of its map, planes and rooms
};

/// Absent when no scan has a pose. final_F may be empty.
[[nodiscard]] std::optional<TrajectoryScore> score_trajectory(const Truth& truth,
                                                              const std::vector<slam::StampedPose>& causal_F,
                                                              const std::vector<slam::StampedPose>& final_F,
                                                              const TrajectoryRules& rules = {});

}  // namespace plumbline::scenarios::score
