// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bim/config/visit.h"
#include "slam/io/estimate.h"
#include "slam/localization/hypotheses.h"
#include "slam/plan_method/prior_yaw.h"

namespace plumbline::slam {

/// When a single answer may be announced, and when it is taken back.
struct ConvergenceConfig {
  double top_mass = 0.95;
  double log_ratio = 5.0;      ///< to the next place [facts: 1.3]
  int updates = 5;             ///< for which this must have held
  double travel_m = 1.0;       ///< and the way walked meanwhile
  double inliers_min = 0.80;   ///< residual test, share of beams on their face; measured 0.78-0.99 in quickstart, up to
                               ///< 0.79 in plans of other buildings with rooms of the same size
  double through_max = 0.05;   ///< share of beams through walls of the plan; measured up to 0.03
  int cluttered_updates = 35;  ///< or this many of Candidate::fits; in plans of other buildings up to 23 were measured
  double restart_through = 0.35;  ///< share of beams through walls but the one that most go through, which may be
                                  ///< missing, of those that do not end before one,
  int restart_updates = 25;       ///< that lets a search begin anew after so many updates
  double rivals_every_m = 3.0;    ///< way walked between two looks for places not thought of
  int rivals = 12;                ///< places looked at before an announcement
  double rival_gap_m = 0.75;      ///< between them
  double rival_gap_rad = 0.35;
  double yaw_drift = told_yaw_drift;

  template <class V>
  void visit(V& v) {
    v("top_mass", top_mass, Field{.min = 0, .max = 1});
    v("log_ratio", log_ratio, Field{.doc = "to the next place", .min = 0});
    v("updates", updates, Field{.doc = "for which this must have held", .min = 1});
    v("travel_m", travel_m, Field{.doc = "and the way walked meanwhile", .min = 0});
    v("inliers_min", inliers_min, Field{.doc = "residual test, share of beams on their face", .min = 0, .max = 1});
    v("through_max", through_max,
      Field{.doc = "share of beams through walls of the plan; measured up to 0.03", .min = 0, .max = 1});
    v("cluttered_updates", cluttered_updates, Field{.doc = "or this many that fit behind clutter", .min = 1});
    v("restart_through", restart_through,
      Field{.doc = "share of beams through walls but one, of those that do not end before one", .min = 0, .max = 1});
    v("restart_updates", restart_updates, Field{.doc = "that lets a search begin anew after so many", .min = 1});
    v("rivals_every_m", rivals_every_m,
      Field{.doc = "way walked between two looks for places not thought of", .min = 0});
    v("rivals", rivals, Field{.doc = "places looked at before an announcement", .min = 1});
    v("rival_gap_m", rival_gap_m, Field{.doc = "between them", .min = 0});
    v("rival_gap_rad", rival_gap_rad, Field{.min = 0});
    v("yaw_drift", yaw_drift, Field{.doc = "rad/s by which the told yaw grows stale", .min = 0});
  }
};

struct SearchConfig {
  LikelihoodConfig likelihood;
  FilterConfig filter;
  PoseClusterConfig clusters;
  RefineConfig refine;
  ProposalConfig proposals;
  ContestConfig contest;
  HypothesisConfig hypotheses;
  ConvergenceConfig convergence;

  template <class V>
  void visit(V& v) {
    v("likelihood", likelihood);
    v("filter", filter);
    v("clusters", clusters);
    v("refine", refine);
    v("proposals", proposals);
    v("contest", contest);
    v("hypotheses", hypotheses);
    v("convergence", convergence);
  }
};

/// Global localization in the plan until one place is left [BIM-Loc section 3.3].
class PlanSearch {
 public:
  PlanSearch(SearchConfig config, std::uint64_t seed);

  /// Takes in one view. start is what is told of the pose now; it matters when the set is drawn anew. Returns the
  /// digest of each stage.
  std::vector<StageDigest> update(const PlanIndex& index, const StartBelief& start, const View& view);
  /// Forgets everything; the next update draws the set anew.
  void restart();

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] const std::vector<Candidate>& candidates() const { return hypotheses_.candidates(); }
  [[nodiscard]] const ParticleSet& particles() const { return particles_; }

 private:
  void judge(const PlanIndex& index, const StartBelief& start, const View& view, double walked);
  /// Looks over the whole storey for places that would have seen the same.
  void find_rivals(const PlanIndex& index, const StartBelief& start, const View& view);

  SearchConfig config_;
  std::uint64_t seed_;
  std::uint64_t tick_ = 0;
  State state_ = State::searching;
  ParticleSet particles_;
  HypothesisSet hypotheses_;
  std::optional<Pose2> last_X_OH_;
  int sure_updates_ = 0;
  double sure_travel_m_ = 0.0;
  double unlooked_m_ = 0.0;  ///< way since the last look for rivals
  int failed_updates_ = 0;
};

}  // namespace plumbline::slam
