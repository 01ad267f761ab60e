// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scenarios/metrics/trajectory.h"
#include "scenarios/report/report.h"
#include "scenarios/run/record.h"

namespace plumbline::scenarios {

struct HypothesisHistories {
  std::vector<HypothesisHistory> shown;
  std::vector<Eigen::Vector2d> others;  ///< (time in s, mass) of those left out together, where they have any
  std::size_t left_out = 0;             ///< how many
};

/// The hypotheses of all scans joined into histories, each moved along by the true motion, since they carry no id.
/// Those with the largest mass over all scans come first (ties: found first), at most `most` of them, before all others
/// those that were the true one for a while. Each is cut where it becomes right (0.5 m, 10 degrees) or wrong; where
/// `judged` is not set, `truth` gives the motion alone, and none is right.
[[nodiscard]] HypothesisHistories hypothesis_histories(const std::vector<BeliefRecord>& beliefs,
                                                       const score::Truth& truth, std::size_t most, bool judged = true);

}  // namespace plumbline::scenarios
