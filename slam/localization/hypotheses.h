// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <deque>
#include <optional>
#include <vector>

#include "bim/config/visit.h"
#include "slam/localization/compare_hypotheses.h"
#include "slam/localization/proposals.h"
#include "slam/localization/refine.h"
#include "slam/particles/pose_clusters.h"

namespace plumbline::slam {

/// How scans add up to how well the plan fits at a pose, where clutter and furniture hide walls. Right poses in
/// furnished and cluttered worlds have 0.3 to 0.9 of the beams on their faces and up to 0.01 penetrate; poses in plans
/// of other buildings soon have 0.1 to 0.5 that penetrate.
struct FitConfig {
  double inliers_doubtful = 0.1;
  double inliers_min = 0.3;
  double inliers_full = 0.5;
  double most_a_scan = 1.5;
  double penetration_max = 0.05;
  double other_penetration_max = 0.03;
  double missing_wall_scan = 0.25;
  double misfit_penetration = 0.06;
  double misfit_scan = 3.0;
  double doubtful_scan = 0.5;
  double clear_penetration = 0.01;
  double limit = 18.0;
  double whole_step_m = 0.2;

  template <class V>
  void visit(V& v) {
    // Chosen on one walk in the duplex, where shelves leave the right pose 12 to 25 %.
    v("inliers_doubtful", inliers_doubtful,
      share_field("share of beams on their face below which a scan counts against the pose"));
    v("inliers_min", inliers_min, share_field("least share of beams on their face for a scan to fit"));
    v("inliers_full", inliers_full, share_field("share at which it counts for one; others in proportion"));
    v("most_a_scan", most_a_scan, plain_field("most that one scan counts for", {.min = 0}));
    v("penetration_max", penetration_max, share_field("largest penetration ratio of a scan that fits"));
    v("other_penetration_max", other_penetration_max,
      share_field(
          "largest penetration ratio, without what one change of the building explains, of a scan that may fit"));
    v("missing_wall_scan", missing_wall_scan, plain_field("what such a scan counts for", {.min = 0}));
    v("misfit_penetration", misfit_penetration,
      share_field("penetration ratio, without what one change explains, above which a scan does not fit"));
    v("misfit_scan", misfit_scan, plain_field("what such a scan counts against the pose", {.min = 0}));
    v("doubtful_scan", doubtful_scan, plain_field("what any other scan counts against it", {.min = 0}));
    v("clear_penetration", clear_penetration,
      share_field("largest penetration ratio of a scan below inliers_min that counts for the pose, in part"));
    v("limit", limit, plain_field("least and largest sum", {.min = 0}));
    // Scans from one place are not independent. As update_m, so that every scan of a walking robot counts whole.
    v("whole_step_m", whole_step_m,
      Field{.doc = "distance from the last scan from which a scan counts whole; nearer ones in proportion",
            .min = 0.01});
  }
  /// What one scan counts for.
  [[nodiscard]] double of_scan(const Agreement& seen) const;
  struct Count {
    double fit = 0.0;
    double scans = 1.0;  ///< in the mean
  };
  /// The same for a pose that is searched for: behind clutter the beams that reach the walls count, if none of them
  /// passes through one.
  [[nodiscard]] Count count_of(const Agreement& seen) const;
  /// How much of a scan counts. step_m: from the scan before.
  [[nodiscard]] double share_of_scan(double step_m) const { return std::min(1.0, step_m / whole_step_m); }
};

struct HypothesisConfig {
  int max_count = 24;
  double covered_mass = 0.99;
  double min_mass = 0.005;
  double match_m = 0.75;
  double match_rad = 0.35;
  double merge_m = 0.30;
  double merge_rad = 0.15;
  double deadband = 0.1;
  double step_cap = 6.0;
  double crossing_cost = 3.0;
  double reference_switch_margin = 1.0;
  double drop_ratio = 25.0;
  int screening_columns = 8;
  double screening_margin = 15.0;
  int history = 240;
  int replay_stride = 3;
  double ema_alpha = 0.15;
  FitConfig fit;
  double unassigned_mass = 0.01;
  double open_share = 0.5;
  double slide_m = 0.3;
  double slide_step_m = 0.1;

  template <class V>
  void visit(V& v) {
    v("max_count", max_count,
      Field{.doc = "most clusters for which hypotheses are tracked one by one", .min = 1, .max = 1000});
    v("covered_mass", covered_mass, share_field("share of the particles' mass that these clusters must hold"));
    v("min_mass", min_mass, share_field("least mass of a cluster that becomes a hypothesis"));
    v("match_m", match_m, Field{.doc = "distance up to which a cluster belongs to a hypothesis", .min = 0});
    v("match_rad", match_rad, Field{.doc = "and angle up to which it does", .min = 0});
    v("merge_m", merge_m, Field{.doc = "distance below which two hypotheses merge", .min = 0});
    v("merge_rad", merge_rad, Field{.doc = "and angle below which they do", .min = 0});
    v("deadband", deadband,
      plain_field("evidence of a scan below which it does not count: a beam or two at an edge of the plan",
                  {.min = 0, .former = "indifference"}));
    v("step_cap", step_cap, plain_field("most evidence of one scan against a hypothesis", {.min = 0}));
    v("crossing_cost", crossing_cost,
      plain_field("evidence against a hypothesis that walks through a wall, which may be a door jamb and noise",
                  {.min = 0}));
    v("reference_switch_margin", reference_switch_margin,
      plain_field("log-likelihood ratio by which a hypothesis must lead the reference to replace it",
                  {.min = 0, .former = "overtaking"}));
    // About three causes.
    v("drop_ratio", drop_ratio,
      plain_field("log-likelihood ratio to the best below which a hypothesis is dropped", {.min = 0}));
    v("screening_columns", screening_columns,
      Field{.doc = "every how many columns of the beam grid the kept scans are compared with first, before a pose is "
                   "tried by all; 1: by all at once",
            .min = 1,
            .max = 100});
    // Assumed; a walk through d6 keeps its hypotheses to the bit.
    v("screening_margin", screening_margin,
      plain_field("log-likelihood ratio below drop_ratio at which the screening rules the pose out", {.min = 0}));
    // 50 m walked.
    v("history", history,
      Field{.doc = "scans kept to replay for a hypothesis that is added later", .min = 1, .max = 10000});
    v("replay_stride", replay_stride,
      Field{.doc = "every how many scans of a full history one is replayed, which stands for all of them; fewer are "
                   "left out of a "
                   "shorter one",
            .min = 1,
            .max = 1000});
    v("ema_alpha", ema_alpha,
      share_field("weight of the newest scan in the moving average of the agreement", {.former = "newest"}));
    v("fit", fit, Field{.former = "cluttered_inliers"});
    v("unassigned_mass", unassigned_mass,
      share_field("mass left to particles of no hypothesis", {.former = "stray_mass"}));
    v("open_share", open_share,
      share_field("share of the prior standard deviation above which a fitted pose's leaves a direction open"));
    // Places that are compared stand 0.5 m apart.
    v("slide_m", slide_m, Field{.doc = "farthest that a pose is moved along it", .min = 0, .max = 5});
    v("slide_step_m", slide_step_m, Field{.doc = "distance between the places that are tried", .min = 0.01});
  }
};

/// Evidence of the scans against and for a hypothesis, from its comparison with the reference.
struct EvidenceBalance {
  EvidenceByCause against, supporting;

  [[nodiscard]] double evidence(const HypothesisComparisonConfig& config) const {
    return supporting.total(config) - against.total(config);
  }
};

/// A pose that the robot may have, tracked by itself.
struct PoseHypothesis {
  int id = -1;
  int storey = 0;
  Pose2 X_IH;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  EvidenceBalance balance;  ///< from its comparison with the reference
  double evidence = 0.0;    ///< log-likelihood ratio to the reference, whose own is 0, that of the yaw prior included
  double mass = 0.0;        ///< share by evidence
  double fit = 0.0;         ///< sum over its scans within FitConfig::limit
  double fit_sum = 0.0;     ///< the same without the limit
  double scans = 0.0;       ///< that it was compared with, each as far as it counts, see FitConfig::whole_step_m
  Agreement agreement;      ///< moving average over the last scans, see HypothesisConfig::ema_alpha

  [[nodiscard]] StoreyPose pose() const { return {storey, X_IH}; }
  [[nodiscard]] double mean_fit() const { return scans > 0 ? fit_sum / scans : 0.0; }
};

/// Hypotheses tracked one by one. The evidence of a hypothesis compares it with the best one so far by every scan, each
/// at its best fitting pose and not where its particles happened to fall: poses that look exactly alike keep exactly
/// equal shares.
class HypothesisSet {
 public:
  HypothesisSet(HypothesisConfig config, RefineConfig refine, LikelihoodConfig likelihood,
                HypothesisComparisonConfig comparison)
      : config_(config), refine_(refine), tracking_refine_(refine), likelihood_(likelihood), comparison_(comparison) {
    tracking_refine_.first_gate_m = refine.tracking_gate_m;
  }

  /// Prior of the yaw at the next scan, which counts in the evidence of every pose: with even odds normal about yaw_I
  /// or uniform. None: yaw is no evidence.
  void expect_yaw(const std::optional<ExpectedYaw>& yaw) { expected_yaw_ = yaw; }
  /// Moves every hypothesis by u, fits it to the scan and adds the scan's evidence.
  void predict_and_update(const PlanIndex& index, const Pose2& u, const LocalizationScan& scan);
  /// Adds clusters that are no hypothesis yet, once few compact ones hold nearly all of the mass.
  void add(const PlanIndex& index, const Clustering& clustering);
  /// Adds the poses that are not known yet and that the kept history does not rule out. One near a known hypothesis is
  /// added where it explains the history better, and takes its place when near ones merge: a hypothesis that clutter
  /// has pulled aside would lose against its alias.
  void add(const PlanIndex& index, const std::vector<StoreyPose>& poses);
  /// The same with the likeliest of those that are not near a known hypothesis. All stay compared with the reference
  /// that they have: pairwise ratios with caps may make a circle of three, and the last would drop the first.
  void add_best(const PlanIndex& index, const std::vector<StoreyPose>& poses);
  /// Compares all with the best one anew, each by all scans kept along one path that ends at its pose. While it was
  /// tracked a hypothesis may have slid along a corridor to where each scan fitted best; one that faces did not hold
  /// along some direction is moved to where the last scan fits best.
  void reassess(const PlanIndex& index);
  /// Sums up anew how well the best one fits, along one path that ends at its pose.
  void replay_best_agreement(const PlanIndex& index);
  /// Merges near ones, drops unlikely ones, normalises the mass.
  void prune_and_normalize();
  /// Scales the particles so that each hypothesis's cluster has its mass, and adds particles where a hypothesis has
  /// none.
  void reweight_particles(ParticleSet& particles, const Clustering& clustering, int quota, std::uint64_t seed,
                          std::uint64_t tick) const;
  void clear();
  /// Keeps the scans.
  void clear_hypotheses() {
    hypotheses_.clear();
    reference_ = 0;
  }

  [[nodiscard]] const std::vector<PoseHypothesis>& all() const { return hypotheses_; }  ///< by mass, then id

 private:
  struct HistoryStep {
    Pose2 u;  ///< motion that led to this scan
    LocalizationScan scan;
    LocalizationScan screening;  ///< the same with a thinner beam grid
    double share = 1.0;          ///< of it that counts for how well the plan fits
  };
  /// One scan as the plan predicts it at a pose.
  struct ScanAtPose {
    Pose2 X_IH;
    PredictedScan predicted;    ///< of the reference; empty for others once they are compared
    std::vector<int> crossed;   ///< elements of the plan that the step to here crosses
    int represented_scans = 1;  ///< that it stands for
  };
  struct Replay {
    std::vector<ScanAtPose> scans;  ///< newest first
    EvidenceBalance balance;        ///< against the reference
    double evidence = 0.0;          ///< from the balance
  };
  struct ReplayedReference {
    StoreyPose pose;
    std::vector<ScanAtPose> scans;
    std::vector<ScanAtPose> screening;
  };
  enum class Grid { whole, screening };
  /// The place along the direction that the fit of the last scan left open, if any.
  void slide_along_open_direction(const PlanIndex& index, PoseHypothesis& hypothesis) const;
  [[nodiscard]] Refined refined_at_last_scan(const PlanIndex& index, const StoreyPose& pose) const;
  /// Adds a pose unless it is known or the kept history rules it out.
  void try_pose(const PlanIndex& index, const StoreyPose& pose, const Eigen::Matrix3d& covariance);
  /// Every how many of the kept scans one is replayed: as many scans at most as of a full history.
  [[nodiscard]] std::size_t replay_stride() const;
  /// The reference's replay, kept until the next scan.
  const ReplayedReference& replayed_reference(const PlanIndex& index);
  /// The same with the thinner beam grid.
  const std::vector<ScanAtPose>& screening_of_reference(const PlanIndex& index);
  [[nodiscard]] StoreyPose fitted_to_last_scan(const PlanIndex& index, const StoreyPose& pose) const;
  /// True where a first look by few columns rules out a pose that is fitted to the last scan.
  [[nodiscard]] bool is_screened_out(const PlanIndex& index, const StoreyPose& start);
  /// True where the last scan is likelier at the first pose.
  [[nodiscard]] bool fits_better(const StoreyIndex& storey, const Pose2& X_IH, const Pose2& other) const;
  /// Adds a scan's agreement with the plan. share: of it that counts.
  void update_agreement(const Agreement& latest, double share, PoseHypothesis& hypothesis) const;
  /// The same for all scans kept.
  void replay_agreement(const StoreyIndex& storey, const std::vector<ScanAtPose>& scans,
                        PoseHypothesis& hypothesis) const;
  /// Adds one scan's evidence for a hypothesis against the reference.
  void accumulate_evidence(const LocalizationScan& scan, const ScanAtPose& own, const ScanAtPose& reference,
                           const HypothesisComparisonConfig& comparison, EvidenceBalance& balance) const;
  /// Compares all hypotheses with the best by all scans kept, once that is a new one: the evidence between two does not
  /// follow from the evidence of each against a third.
  void rebase_reference(const PlanIndex& index);
  void compare_all_with_reference(const PlanIndex& index);
  /// The kept scans along the odometry back from a pose fitted to the last one, compared with the reference (when there
  /// is one). Stops once the evidence has fallen below the ratio at which the pose is dropped.
  [[nodiscard]] Replay replay(const PlanIndex& index, const StoreyPose& start, const std::vector<ScanAtPose>& reference,
                              Grid grid = Grid::whole) const;
  /// Log-likelihood ratio of a pose's yaw to the reference's by what is expected.
  [[nodiscard]] double yaw_evidence(const Pose2& X_IH) const;
  [[nodiscard]] int find(const StoreyPose& pose, double near_m, double near_rad) const;

  HypothesisConfig config_;
  RefineConfig refine_;           ///< of a new hypothesis
  RefineConfig tracking_refine_;  ///< of a tracked one
  LikelihoodConfig likelihood_;
  HypothesisComparisonConfig comparison_;
  std::vector<PoseHypothesis> hypotheses_;
  std::deque<HistoryStep> history_;
  std::optional<ReplayedReference> replayed_reference_;
  std::vector<StoreyPose> ruled_out_;  ///< since the last scan, fitted to it
  std::optional<ExpectedYaw> expected_yaw_;
  int next_id_ = 0;
  std::size_t reference_ = 0;  ///< hypothesis that the others are compared with
};

}  // namespace plumbline::slam
