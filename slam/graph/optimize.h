// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/config/visit.h"
#include "slam/graph/graph.h"

namespace plumbline::slam {

struct OptimizerConfig {
  int max_iterations = 12;
  double relative_decrease = 1e-4;
  double huber = 2.0;
  double loop_huber = 1.0;

  template <class V>
  void visit(V& v) {
    v("max_iterations", max_iterations, Field{.doc = "most iterations of one optimisation", .min = 1});
    v("relative_decrease", relative_decrease,
      plain_field("relative decrease of the cost below which an optimisation stops", {.min = 0}));
    v("huber", huber,
      plain_field("whitened residual above which plane, room and duplicate factors count linearly (Huber)",
                  {.min = 0}));
    v("loop_huber", loop_huber,
      plain_field("whitened residual above which loop closures count linearly (Huber)", {.min = 0}));
  }
};

struct OptimizeReport {
  int iterations = 0;
  double initial_cost = 0.0;
  double final_cost = 0.0;
  int keyframes = 0;  ///< that were free to move
  int terms = 0;      ///< factors in the problem
};

/// Optimises the keyframes from first_free on (at least 1: keyframe 0 holds the gauge), the planes they see, and the
/// rooms and floors that hang on those planes [bavle2023, section V]. Older keyframes stay where they are and go on
/// holding the planes they saw. Levenberg-Marquardt, one thread, Eigen only; stops after max_iterations or when the
/// cost's relative decrease falls below the limit. Throws InternalError when the solver fails numerically.
OptimizeReport optimize(Graph& graph, int first_free, const OptimizerConfig& config);

}  // namespace plumbline::slam
