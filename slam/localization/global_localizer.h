// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bim/config/visit.h"
#include "slam/io/estimate.h"
#include "slam/localization/alias_search.h"
#include "slam/localization/hypotheses.h"
#include "slam/plan_method/prior_yaw.h"

namespace plumbline::slam {

/// When a single answer is announced, and when it is withdrawn.
struct ConvergenceConfig {
  double top_mass = 0.95;
  double log_ratio = 5.0;
  int updates = 5;
  double travel_m = 1.0;
  double inliers_min = 0.80;
  double max_penetration_ratio = 0.05;
  double min_fit = 6.0;
  double min_mean_fit = 0.45;
  double restart_penetration_ratio = 0.35;
  int restart_updates = 25;
  double alternatives_every_m = 3.0;
  int alternatives = 12;
  double alternative_gap_m = 0.75;
  double alternative_gap_rad = 0.35;
  double yaw_drift = prior_yaw_drift;

  template <class V>
  void visit(V& v) {
    v("top_mass", top_mass, share_field("share of the mass that the best hypothesis must hold", {.basic = true}));
    v("log_ratio", log_ratio,
      plain_field("log-likelihood ratio to the next hypothesis that is required", {.min = 0, .basic = true}));
    v("updates", updates, Field{.doc = "updates in a row for which this must hold", .min = 1, .basic = true});
    v("travel_m", travel_m, Field{.doc = "distance walked for which this must hold", .min = 0, .basic = true});
    // Measured: 0.78 to 0.99 in quickstart, up to 0.79 in plans of other buildings with rooms of the same size.
    v("inliers_min", inliers_min, share_field("least share of beams on their predicted face", {.basic = true}));
    // Measured: up to 0.03.
    v("max_penetration_ratio", max_penetration_ratio,
      share_field("largest share of beams that penetrate walls of the plan", {.former = "through_max"}));
    // Chosen on seven furnished walks in their own plans, and on d2 and the house in plans of other buildings; the mean
    // of 15 walks on construction sites came to 0.5 to 1.1.
    v("min_fit", min_fit,
      plain_field("sum of scans that fit which suffices instead of inliers_min, behind clutter",
                  {.min = 0, .former = "cluttered_updates"}));
    v("min_mean_fit", min_mean_fit,
      plain_field("least mean of all its scans, also where inliers_min holds", {.min = -3, .max = 3}));
    // Among the beams that are not cut short; the wall that most beams penetrate may be missing.
    v("restart_penetration_ratio", restart_penetration_ratio,
      share_field("share of penetrating beams, without those of one change, that counts towards a restart",
                  {.former = "restart_through"}));
    v("restart_updates", restart_updates,
      Field{.doc = "updates above this ratio after which the search restarts", .min = 1});
    v("alternatives_every_m", alternatives_every_m,
      Field{
          .doc = "distance walked between two searches for further hypotheses", .min = 0, .former = "rivals_every_m"});
    v("alternatives", alternatives,
      Field{.doc = "further hypotheses tried before a convergence is announced", .min = 1, .former = "rivals"});
    v("alternative_gap_m", alternative_gap_m,
      Field{.doc = "least distance between two of them", .min = 0, .former = "rival_gap_m"});
    v("alternative_gap_rad", alternative_gap_rad,
      Field{.doc = "or least angle between two of them", .min = 0, .former = "rival_gap_rad"});
    v("yaw_drift", yaw_drift,
      Field{.doc = "rate at which the standard deviation of the prior yaw grows", .unit = "rad/s", .min = 0});
  }
};

struct GlobalLocalizerConfig {
  LikelihoodConfig likelihood;
  FilterConfig filter;
  PoseClusterConfig clusters;
  RefineConfig refine;
  ProposalConfig proposals;
  AliasSearchConfig aliases;
  HypothesisComparisonConfig comparison;
  HypothesisConfig hypotheses;
  ConvergenceConfig convergence;

  template <class V>
  void visit(V& v) {
    v("likelihood", likelihood);
    v("filter", filter);
    v("clusters", clusters);
    v("refine", refine);
    v("proposals", proposals);
    v("aliases", aliases);
    v("comparison", comparison, Field{.former = "contest"});
    v("hypotheses", hypotheses);
    v("convergence", convergence);
  }
};

/// Global localization in the plan until one hypothesis is left [shaheer2023, section 3.3].
class GlobalLocalizer {
 public:
  GlobalLocalizer(GlobalLocalizerConfig config, std::uint64_t seed);

  /// Processes one scan. start: the prior of the present pose, used when the set is drawn anew. Returns the digest of
  /// each stage.
  std::vector<StageDigest> update(const PlanIndex& index, const StartPrior& start, const LocalizationScan& scan);
  /// Forgets everything; the next update draws the set anew.
  void restart();

  /// Poses from which the plan looks as from this one.
  [[nodiscard]] std::vector<StoreyPose> aliases(const PlanIndex& index, const StoreyPose& pose, const StartPrior& prior,
                                                const LocalizationScan& scan);

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] const std::vector<PoseHypothesis>& hypotheses() const { return hypotheses_.all(); }
  [[nodiscard]] const ParticleSet& particles() const { return particles_; }

 private:
  void update_state(const PlanIndex& index, const StartPrior& start, const LocalizationScan& scan, double walked);
  /// True for two poses that one hypothesis may have.
  [[nodiscard]] bool is_same(const StoreyPose& a, const StoreyPose& b) const;
  /// Searches the whole storey for aliased poses.
  void find_alternatives(const PlanIndex& index, const StartPrior& start, const LocalizationScan& scan);

  GlobalLocalizerConfig config_;
  std::uint64_t seed_;
  std::uint64_t tick_ = 0;
  State state_ = State::searching;
  ParticleSet particles_;
  HypothesisSet hypotheses_;
  std::optional<AliasSearch> alias_search_;  ///< made when first needed
  std::optional<Pose2> last_X_OH_;
  int converged_updates_ = 0;
  double converged_travel_m_ = 0.0;
  double since_alternatives_m_ = 0.0;  ///< distance since the last search for alternatives
  int failed_updates_ = 0;
};

}  // namespace plumbline::slam
