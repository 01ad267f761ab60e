// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "scenarios/metrics/trajectory.h"

namespace plumbline::scenarios::score {

/// Rules of the loop metrics, docs/reference/metrics.md.
struct LoopRules {
  double max_error_m = 0.2;    ///< of the measured relative pose of a right loop
  double max_error_deg = 3.0;  ///< the same for its rotation
  double revisit_m = 1.0;      ///< horizontal distance from where the robot was before that is a revisit
  double level_m = 1.0;        ///< and difference of height, so that storeys are apart
  double min_walked_m = 10.0;  ///< walked between the two visits
  double piece_m = 10.0;       ///< a longer revisit counts as several
  double min_piece_m = 1.0;    ///< a shorter one is a touch and does not count
  double sample_m = 0.25;      ///< distance walked between the places that are compared
};

struct LoopScore {
  int found = 0;                    ///< loop closures that the method kept
  int right = 0;                    ///< of these, with a relative pose near the true one
  int revisits = 0;                 ///< pieces of way that lead along an earlier one
  int closed = 0;                   ///< of these, with a right loop that ends in them
  std::optional<double> precision;  ///< right / found; absent when none was found
  std::optional<double> recall;     ///< closed / revisits; absent when nothing was revisited
};

/// Way that leads along an earlier one, by distances walked, m.
struct Revisit {
  double from_m = 0.0, to_m = 0.0;
};

/// The true revisits of a walk in order.
[[nodiscard]] std::vector<Revisit> revisits(const Truth& truth, const LoopRules& rules = {});

[[nodiscard]] LoopScore score_loops(const std::vector<slam::LoopEdge>& loops, const Truth& truth,
                                    const LoopRules& rules = {});

}  // namespace plumbline::scenarios::score
