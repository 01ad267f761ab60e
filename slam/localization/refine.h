// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "bim/config/visit.h"
#include "slam/plan_map/likelihood.h"

namespace plumbline::slam {

struct RefineConfig {
  int iterations = 4;
  double first_gate_m = 0.6;  ///< beams farther from the face they should meet are left out; halves each iteration
  double last_gate_m = 0.15;
  double follow_gate_m = 0.25;  ///< first gate of a place already fitted, which clutter before a wall must not pull
  double prior_sigma_m = 0.10;  ///< of the pose handed in: holds what the beams do not see, as along a corridor
  double prior_sigma_rad = 0.03;
  double inlier_m = 0.15;  ///< a beam this close to the face it should meet agrees with the plan

  template <class V>
  void visit(V& v) {
    v("iterations", iterations, Field{.min = 1});
    v("first_gate_m", first_gate_m,
      Field{.doc = "beams farther from the face they should meet are left out", .min = 0});
    v("last_gate_m", last_gate_m, Field{.min = 0});
    v("follow_gate_m", follow_gate_m,
      Field{.doc = "first gate of a place already fitted, which clutter before a wall must not pull", .min = 0});
    v("prior_sigma_m", prior_sigma_m, Field{.doc = "of the pose handed in", .min = 1e-6});
    v("prior_sigma_rad", prior_sigma_rad, Field{.min = 1e-6});
    v("inlier_m", inlier_m,
      Field{.doc = "a beam this close to the face it should meet agrees with the plan", .min = 0});
  }
};

/// A pose moved to where the beams meet the plan's faces best.
struct Refined {
  Pose2 X_IH;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of (x, y, yaw) in I
};

/// Gauss-Newton on point-to-face distances over (x, y, yaw).
[[nodiscard]] Refined refine(const StoreyIndex& storey, const Pose2& X_IH, const View& view,
                             const LikelihoodConfig& likelihood, const RefineConfig& config);

/// How well one view agrees with the plan at a pose.
struct Agreement {
  double inliers = 0.0;      ///< share of beams that end within inlier_m of the face they should meet
  double through = 0.0;      ///< share that goes through a face of the plan; the rest is cut short, by clutter or so
  double through_one = 0.0;  ///< of these, through either side of the wall that most go through: it may not be built

  /// Share of beams that go through, of those that are not cut short, without the wall that most go through.
  [[nodiscard]] double through_others_share() const {
    const double others = through - through_one;
    return others / (inliers + others + 1e-9);
  }
  /// Becomes a mean in which the newest has this weight.
  void take_in(const Agreement& newest, double weight) {
    inliers += weight * (newest.inliers - inliers);
    through += weight * (newest.through - through);
    through_one += weight * (newest.through_one - through_one);
  }
};
[[nodiscard]] Agreement agreement(const StoreyIndex& storey, const Pose2& X_IH, const View& view,
                                  const LikelihoodConfig& likelihood, const RefineConfig& config);

}  // namespace plumbline::slam
