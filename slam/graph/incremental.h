// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/config/visit.h"
#include "slam/graph/marginal_prior.h"

namespace plumbline::slam {

struct IncrementalConfig {
  bool batch = false;
  int window = 15;
  int boundary_planes = 20;
  double global_solve_share = 0.05;
  int global_solve_spacing = 5;
  double urgent_chi2 = 16.8;

  template <class V>
  void visit(V& v) {
    v("batch", batch,
      Field{.doc = "optimise the whole graph at each keyframe, as the papers do, instead of a window",
            .former = "everything"});
    v("window", window, Field{.doc = "latest keyframes that the optimisation at each keyframe may move", .min = 2});
    v("boundary_planes", boundary_planes,
      Field{.doc = "planes outside the window, latest first, that the prior keeps describing", .min = 0});
    // A solve is paid for before the next, so that the mean cost of a keyframe does not grow.
    v("global_solve_share", global_solve_share,
      share_field("keyframes between two solves of a whole storey, as a share of all", {.former = "full_share"}));
    v("global_solve_spacing", global_solve_spacing,
      Field{
          .doc = "least number of keyframes between two solves of a whole storey", .min = 1, .former = "full_spacing"});
    // 6 degrees of freedom, 99 %.
    v("urgent_chi2", urgent_chi2,
      plain_field("χ² of a loop closure against the estimate above which a storey is solved at once", {.min = 0}));
  }
};

/// Optimises a growing graph at a cost per keyframe that does not grow: at each keyframe the latest ones with the
/// planes, rooms and floors they bear on, all else marginalised into a linear prior, docs/methods/back_end.md; on
/// demand a storey or the whole graph, after which the prior is linearised anew. Factors of poses and planes are
/// appended in the order of their newest keyframe. A plane or a loop that leads back to what has been marginalised
/// counts for nothing before the next such solve: late, but never twice.
class IncrementalOptimizer {
 public:
  IncrementalOptimizer(const IncrementalConfig& config, const OptimizerConfig& optimizer)
      : config_(config), optimizer_(optimizer) {}

  /// After each new keyframe.
  OptimizeReport update(Graph& graph);
  /// Optimises from keyframe first_free on; call relinearize() before the next update().
  OptimizeReport solve(Graph& graph, int first_free);
  /// Builds the prior anew at the graph's estimates. Needed whenever old factors changed.
  void relinearize(const Graph& graph);

  /// True when a plane of the newest keyframe was known but marginalised: a soft loop.
  [[nodiscard]] bool revisited_marginalized_plane() const { return revisited_marginalized_plane_; }
  /// Whether a wanted solve may be done: enough keyframes since the last.
  [[nodiscard]] bool solve_is_due(const Graph& graph) const;

  [[nodiscard]] const MarginalPrior& prior() const { return prior_; }
  /// The oldest keyframe that is not marginalised.
  [[nodiscard]] int first_keyframe() const { return first_; }

 private:
  void update_last_seen(const Graph& graph);
  void marginalize_before(const Graph& graph, int first);
  [[nodiscard]] std::vector<VertexId> kept(const Graph& graph, int first) const;
  [[nodiscard]] FactorSelection window_factors(const Graph& graph) const;

  IncrementalConfig config_;
  OptimizerConfig optimizer_;
  int first_ = 0;
  MarginalPrior prior_;
  std::vector<int> last_seen_;  ///< newest keyframe that saw a plane; index = plane
  int solved_at_ = 0;           ///< keyframes there were at the last solve
  bool revisited_marginalized_plane_ = false;
};

}  // namespace plumbline::slam
