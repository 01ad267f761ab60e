// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/config/visit.h"
#include "slam/graph/marginal_prior.h"

namespace plumbline::slam {

struct IncrementalConfig {
  bool everything = false;   ///< no window: the whole graph at each keyframe, as in the papers
  int window = 15;           ///< latest keyframes that every keyframe's optimisation may move
  int boundary_planes = 20;  ///< planes, the latest seen, that the prior goes on describing when the window left them
  double full_share = 0.05;  ///< keyframes between two solves of a storey, of all keyframes: a solve is paid for before
                             ///< the next, so that the mean cost of a keyframe does not grow
  int full_spacing = 5;      ///< and at least so many
  double urgent_chi2 = 16.8;  ///< of a loop closure against the estimate, 6 dof, 99 %: solved at once

  template <class V>
  void visit(V& v) {
    v("everything", everything, Field{.doc = "optimise the whole graph at each keyframe"});
    v("window", window, Field{.doc = "latest keyframes that move at each keyframe", .min = 2});
    v("boundary_planes", boundary_planes, Field{.doc = "planes behind the window that its prior describes", .min = 0});
    v("full_share", full_share, Field{.doc = "keyframes between solves of a storey, of all", .min = 0, .max = 1});
    v("full_spacing", full_spacing, Field{.doc = "keyframes between solves of a storey, at least", .min = 1});
    v("urgent_chi2", urgent_chi2, Field{.doc = "of a loop closure that is solved at once", .min = 0});
  }
};

/// Optimises a growing graph at a cost per keyframe that does not grow: at each keyframe the latest ones with the
/// planes, rooms and floors they bear on, all else marginalised into a linear prior [facts: slam 3.6, 8.3]; on demand a
/// storey or the whole graph, after which the prior is linearised anew. Factors of poses and planes are appended in the
/// order of their newest keyframe. A plane or a loop that leads back to what has been marginalised counts for nothing
/// before the next such solve: late, but never twice.
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
  [[nodiscard]] bool returned() const { return returned_; }
  /// Whether a wanted solve may be done: enough keyframes since the last.
  [[nodiscard]] bool solve_is_due(const Graph& graph) const;

  [[nodiscard]] const MarginalPrior& prior() const { return prior_; }
  /// The oldest keyframe that is not marginalised.
  [[nodiscard]] int first_keyframe() const { return first_; }

 private:
  void note_planes(const Graph& graph);
  void leave(const Graph& graph, int first);
  [[nodiscard]] std::vector<VertexId> kept(const Graph& graph, int first) const;
  [[nodiscard]] FactorSelection window_factors(const Graph& graph) const;

  IncrementalConfig config_;
  OptimizerConfig optimizer_;
  int first_ = 0;
  MarginalPrior prior_;
  std::vector<int> last_seen_;  ///< newest keyframe that saw a plane; index = plane
  int solved_at_ = 0;           ///< keyframes there were at the last solve
  bool returned_ = false;
};

}  // namespace plumbline::slam
