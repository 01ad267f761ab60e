// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "bim/config/visit.h"
#include "slam/plan_map/likelihood.h"

namespace plumbline::slam {

struct RefineConfig {
  int iterations = 4;
  double first_gate_m = 0.6;
  double last_gate_m = 0.15;
  double tracking_gate_m = 0.25;
  double cauchy_share = 0.5;
  double prior_sigma_m = 0.10;
  double prior_sigma_rad = 0.03;
  double inlier_m = 0.15;

  template <class V>
  void visit(V& v) {
    v("iterations", iterations, Field{.doc = "Gauss-Newton iterations", .min = 1});
    v("first_gate_m", first_gate_m,
      Field{.doc = "distance from the expected face beyond which a beam is left out; halves each iteration", .min = 0});
    v("last_gate_m", last_gate_m, Field{.doc = "least value of this gate", .min = 0});
    v("tracking_gate_m", tracking_gate_m,
      Field{.doc = "first gate of a tracked pose, which clutter in front of a wall must not pull",
            .min = 0,
            .former = "follow_gate_m"});
    // Of the last gate alone: a wider one must draw a pose in from afar. Fronts of furniture 5 to 15 cm before a wall
    // drew poses up to 6 cm aside; chosen on a furnished walk in the duplex and 116 others.
    v("cauchy_share", cauchy_share,
      plain_field("scale of the Cauchy kernel of a beam's distance, as a share of the last gate",
                  {.min = 0.01, .max = 100}));
    v("prior_sigma_m", prior_sigma_m,
      Field{.doc = "standard deviation of the initial position, which holds unobserved directions", .min = 1e-6});
    v("prior_sigma_rad", prior_sigma_rad, Field{.doc = "standard deviation of the initial attitude", .min = 1e-6});
    v("inlier_m", inlier_m,
      Field{.doc = "distance from the expected face up to which a beam agrees with the plan", .min = 0});
  }
};

/// A pose moved to where the beams fit the plan's faces best.
struct Refined {
  Pose2 X_IH;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of (x, y, yaw) in I
};

/// Gauss-Newton on point-to-face distances over (x, y, yaw), at the last gate with a Cauchy kernel.
[[nodiscard]] Refined refine(const StoreyIndex& storey, const Pose2& X_IH, const LocalizationScan& scan,
                             const LikelihoodConfig& likelihood, const RefineConfig& config);

/// How well one scan agrees with the plan at a pose.
struct Agreement {
  double inliers = 0.0;            ///< share of beams that end within inlier_m of the face they should hit
  double penetration_ratio = 0.0;  ///< share that penetrates a face of the plan; the rest is cut short, as by clutter
  /// Of these, what one change of the building explains at most: a wall that is not built, where more beams penetrate
  /// it than end at it, or one opening that is not planned, where beams penetrate a wall side by side.
  double penetration_ratio_one_change = 0.0;

  /// Share of penetrating beams among those that are not cut short, without those of one change.
  [[nodiscard]] double penetration_ratio_otherwise() const {
    const double others = penetration_ratio - penetration_ratio_one_change;
    return others / (inliers + others + 1e-9);
  }
  /// Exponential moving average, in which the latest has this weight.
  void update_mean(const Agreement& latest, double weight) {
    inliers += weight * (latest.inliers - inliers);
    penetration_ratio += weight * (latest.penetration_ratio - penetration_ratio);
    penetration_ratio_one_change += weight * (latest.penetration_ratio_one_change - penetration_ratio_one_change);
  }
};
[[nodiscard]] Agreement agreement(const StoreyIndex& storey, const Pose2& X_IH, const LocalizationScan& scan,
                                  const LikelihoodConfig& likelihood, const RefineConfig& config);

}  // namespace plumbline::slam
