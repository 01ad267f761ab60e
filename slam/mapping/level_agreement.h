// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <deque>
#include <optional>
#include <vector>

#include "bim/config/visit.h"
#include "bim/geometry/pose.h"
#include "slam/graph/factors.h"
#include "slam/scan/plane_observation.h"

namespace plumbline::slam {

struct LevelAgreementConfig {
  bool drop = true;
  int keyframes = 10;
  double usual_chi2 = 3.0;
  double contradicted_share = 0.3;
  double near_m = 0.25;
  double near_rad = 0.08;
  int way_keyframes = 50;
  double way_chi2 = 1.5;

  template <class V>
  void visit(V& v) {
    v("drop", drop, Field{.doc = "drops floors and ceilings that contradict the odometry: open ground is no floor"});
    v("keyframes", keyframes,
      Field{.doc = "latest keyframes whose floors and ceilings a new one is compared with", .min = 1, .max = 1000});
    // The mean of three degrees of freedom. Floors of quickstart, se1 and c1f1 have 2.3 at most, mounds 5 to 350.
    v("usual_chi2", usual_chi2,
      plain_field("χ² of a floor or ceiling to these in the median above which it contradicts them", {.min = 0}));
    // Assumed; floors of those walks have none.
    v("contradicted_share", contradicted_share,
      share_field("share of the latest floors, or ceilings, that contradict: from here on none is used"));
    // Both as in the association, WallLayerConfig::floor_offset_m and floor_angle_rad.
    v("near_m", near_m, Field{.doc = "offset up to which two are compared; others are other surfaces", .min = 0});
    v("near_rad", near_rad, Field{.doc = "angle up to which two are compared", .min = 0, .max = 1});
    // Of keyframes 0.6 m apart the way is 30 m. Storeys are farther apart than the odometry's drift over it.
    v("way_keyframes", way_keyframes,
      Field{
          .doc =
              "latest keyframes with the older half of whose floors a new one is compared over the whole way; 0: none",
          .min = 0,
          .max = 1000});
    // The mean is 3, but the odometry is better than its covariance says. In the median over quickstart and c1f1 with
    // LiDAR alone floors 20, 33 and 66 keyframes before have 0.1 to 0.5, on two streets with slopes 1.2 to 3.9.
    v("way_chi2", way_chi2,
      plain_field("χ² of a floor to these in the median above which the ground between them slopes", {.min = 0}));
  }
};

/// Whether floors and ceilings of successive keyframes are the one plane that the graph takes them for. A fit finds a
/// level plane on a mound and in the crown of a tree, too, and the next keyframe finds another one there. Odometry
/// tells them apart: over a few metres it is sure of height and tilt. Gentle slopes contradict only over a longer way.
class LevelAgreement {
 public:
  explicit LevelAgreement(const LevelAgreementConfig& config) : config_(config) {}

  /// A new keyframe begins, a step after the one before. covariance: of its right increment (translation, rotation).
  void add_step(const Pose& step, const Matrix6d& covariance);
  /// Drops floors and ceilings of the new keyframe that contradict those before, and ceilings that none before
  /// confirms.
  void drop_contradicted(std::vector<PlaneObservation>& seen);
  /// Where the new keyframe shows that the ground slopes: the first keyframe whose floor it was compared with. None
  /// while it is known to slope.
  [[nodiscard]] std::optional<int> sloping_since() const { return sloping_since_; }

 private:
  /// A floor or ceiling of a keyframe.
  struct Look {
    PlaneObservation level;
    int keyframe = 0;
    Pose X_KR;  ///< of the newest keyframe in this one
    Matrix6d covariance = Matrix6d::Zero();
  };

  /// r: of the former look and the level. By the covariances of both and of the way between them.
  [[nodiscard]] static double chi2(const Look& former, const PlaneResidual& r, const PlaneObservation& level);
  /// To each of the latest that may be the same surface.
  [[nodiscard]] std::vector<double> chi2_to_latest(const PlaneObservation& level) const;
  /// Whether a floor contradicts those of the older half of way_keyframes, which odometry, not the map, takes for the
  /// same surface.
  [[nodiscard]] bool contradicts_way(const PlaneObservation& floor) const;
  /// After the floors of the new keyframe: whether the ground slopes.
  void judge_slope(bool seen, bool contradicts);

  LevelAgreementConfig config_;
  int keyframe_ = -1;
  std::deque<Look> latest_;
  std::array<std::deque<bool>, 2> contradictions_;  ///< of the latest floors and of the latest ceilings
  std::deque<bool> way_contradictions_;             ///< of the floors of the latest keyframes, over the whole way
  bool slopes_ = false;
  std::optional<int> sloping_since_;
};

}  // namespace plumbline::slam
