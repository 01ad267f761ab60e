// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <deque>
#include <vector>

#include "bim/config/visit.h"
#include "slam/localization/compare_hypotheses.h"
#include "slam/localization/proposals.h"
#include "slam/localization/refine.h"
#include "slam/particles/pose_clusters.h"

namespace plumbline::slam {

struct HypothesisConfig {
  int max_count = 24;          ///< clusters up to which places are followed one by one
  double covered_mass = 0.99;  ///< of the particles that these clusters must hold
  double min_mass = 0.005;     ///< of a cluster that becomes a hypothesis
  double match_m = 0.75;       ///< a cluster this close to a hypothesis is the same place
  double match_rad = 0.35;
  double merge_m = 0.30;  ///< hypotheses this close are one
  double merge_rad = 0.15;
  double indifference = 0.1;        ///< of what a view says, not counted: a beam or two at an edge of the plan
  double step_cap = 6.0;            ///< most that one view says against a hypothesis
  double crossing_cost = 3.0;       ///< against one that walks through a wall: may be a door jamb and noise
  double overtaking = 1.0;          ///< log-ratio by which a place must lead the one that all are held against
  double drop_ratio = 25.0;         ///< log-ratio to the best below which a hypothesis is dropped: three causes
  int history = 240;                ///< views kept to judge a hypothesis that turns up later; 50 m of way
  int replay_stride = 3;            ///< of these views, one in so many is looked at, for all of them
  double newest = 0.15;             ///< weight of the newest view in the agreement with the last ones
  double cluttered_inliers = 0.30;  ///< share of beams that meet their face where much stands before the walls,
  double cluttered_through = 0.10;  ///< and share of those that go through one, of both
  int least_fits = -18;             ///< of a candidate: so long is it held against it that views did not fit
  double stray_mass = 0.01;         ///< left to particles of no hypothesis

  template <class V>
  void visit(V& v) {
    v("max_count", max_count,
      Field{.doc = "clusters up to which places are followed one by one", .min = 1, .max = 1000});
    v("covered_mass", covered_mass, Field{.doc = "of the particles that these clusters must hold", .min = 0, .max = 1});
    v("min_mass", min_mass, Field{.doc = "of a cluster that becomes a hypothesis", .min = 0, .max = 1});
    v("match_m", match_m, Field{.doc = "a cluster this close to a hypothesis is the same place", .min = 0});
    v("match_rad", match_rad, Field{.min = 0});
    v("merge_m", merge_m, Field{.doc = "hypotheses this close are one", .min = 0});
    v("merge_rad", merge_rad, Field{.min = 0});
    v("indifference", indifference,
      Field{.doc = "of what a view says, not counted: a beam or two at an edge of the plan", .min = 0});
    v("step_cap", step_cap, Field{.doc = "most that one view says against a hypothesis", .min = 0});
    v("crossing_cost", crossing_cost,
      Field{.doc = "against one that walks through a wall: may be a door jamb and noise", .min = 0});
    v("overtaking", overtaking,
      Field{.doc = "log-ratio by which a place must lead the one that all are held against", .min = 0});
    v("drop_ratio", drop_ratio, Field{.doc = "log-ratio to the best below which a hypothesis is dropped", .min = 0});
    v("history", history,
      Field{.doc = "views kept to judge a hypothesis that turns up later; 50 m of way", .min = 1, .max = 10000});
    v("replay_stride", replay_stride,
      Field{.doc = "of these views, one in so many is looked at, for all of them", .min = 1, .max = 1000});
    v("newest", newest,
      Field{.doc = "weight of the newest view in the agreement with the last ones", .min = 0, .max = 1});
    v("cluttered_inliers", cluttered_inliers,
      Field{.doc = "share of beams that meet their face where much stands before the walls", .min = 0, .max = 1});
    v("cluttered_through", cluttered_through,
      Field{.doc = "and share of those that go through one, of both", .min = 0, .max = 1});
    v("least_fits", least_fits,
      Field{.doc = "of a candidate: so long is it held against it that views did not fit", .max = 0});
    v("stray_mass", stray_mass, Field{.doc = "left to particles of no hypothesis", .min = 0, .max = 1});
  }
};

/// What views said of a place and of another one that it was held against.
struct Case {
  Objections against, for_it;

  [[nodiscard]] double evidence(double cause_cap) const { return for_it.total(cause_cap) - against.total(cause_cap); }
};

/// A place the robot may be in, followed by itself.
struct Candidate {
  int id = -1;
  int storey = 0;
  Pose2 X_IH;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  Case held;              ///< what its comparison with the reference brought up
  double evidence = 0.0;  ///< log-likelihood ratio to the reference, whose own is 0
  double mass = 0.0;      ///< share by evidence
  int fits = 0;           ///< views that fit behind clutter, less twice those that do not
  Agreement agreement;    ///< with the last views, the newest with weight HypothesisConfig::newest

  [[nodiscard]] Place place() const { return {storey, X_IH}; }
};

/// Places followed one by one. The evidence of a place is what every view says for it and against the best place so
/// far, each at the pose that fits it best, not the luck of where its particles fell: places that look exactly alike
/// keep exactly equal shares.
class HypothesisSet {
 public:
  HypothesisSet(HypothesisConfig config, RefineConfig refine, LikelihoodConfig likelihood, ContestConfig contest)
      : config_(config), refine_(refine), follow_(refine), likelihood_(likelihood), contest_(contest) {
    follow_.first_gate_m = refine.follow_gate_m;
  }

  /// Moves every candidate by u, fits it to the view and adds what the view says.
  void follow(const PlanIndex& index, const Pose2& u, const View& view);
  /// Adds clusters that are no candidate yet, once few compact ones hold nearly all of the mass.
  void adopt(const PlanIndex& index, const Clustering& clustering);
  /// Adds the places that are not known yet and that the kept history does not rule out.
  void adopt(const PlanIndex& index, const std::vector<Place>& places);
  /// Merges, drops the hopeless, shares out the mass.
  void settle();
  /// Scales the particles so that each candidate's cluster has its mass, and brings back candidates without particles.
  void impose(ParticleSet& particles, const Clustering& clustering, int quota, std::uint64_t seed,
              std::uint64_t tick) const;
  void clear();
  /// Keeps the views.
  void forget_places() {
    candidates_.clear();
    reference_ = 0;
  }

  [[nodiscard]] const std::vector<Candidate>& candidates() const { return candidates_; }  ///< by mass, then id

 private:
  struct Step {
    Pose2 u;  ///< motion that led to this view
    View view;
  };
  /// What the plan shows at a place for one view.
  struct Look {
    Pose2 X_IH;
    Sight sight;               ///< of the reference; of others none, once held against it
    std::vector<int> crossed;  ///< elements of the plan that the way here goes through
    int views = 1;             ///< that it stands for
  };
  struct Replay {
    std::vector<Look> looks;  ///< newest first
    Case held;                ///< against the reference
    double evidence = 0.0;    ///< of the case
  };
  /// Takes in how well the newest view agrees with the plan.
  void note(const Agreement& newest, Candidate& candidate) const;
  /// The same for all views kept.
  void note_past(const StoreyIndex& storey, const std::vector<Look>& looks, Candidate& candidate) const;
  /// Adds what one view says for a place against the reference.
  void judge(const View& view, const Look& look, const Look& reference, Case& held) const;
  /// Holds all candidates against the best by all views kept, once that is another one: what speaks for one place
  /// against another cannot be told from what speaks for each against a third.
  void agree_on_reference(const PlanIndex& index);
  /// The kept views along the odometry back from the pose at the last one, held against the reference (when there is
  /// one). Stops once the evidence has fallen below the drop ratio.
  [[nodiscard]] Replay replay(const PlanIndex& index, const Place& place, const std::vector<Look>& reference) const;
  [[nodiscard]] int find(const Place& place, double near_m, double near_rad) const;

  HypothesisConfig config_;
  RefineConfig refine_;  ///< of a place that turns up
  RefineConfig follow_;  ///< of one carried along
  LikelihoodConfig likelihood_;
  ContestConfig contest_;
  std::vector<Candidate> candidates_;
  std::deque<Step> history_;
  int next_id_ = 0;
  std::size_t reference_ = 0;  ///< candidate that the others are held against
};

}  // namespace plumbline::slam
