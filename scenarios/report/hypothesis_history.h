// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scenarios/metrics/trajectory.h"
#include "scenarios/report/report.h"
#include "scenarios/run/record.h"

namespace plumbline::scenarios {

/// The hypotheses of all scans joined into places, each carried along by the true motion: hypotheses name none. Those
/// that ever held most of the belief come first (ties: found first), at most `most` of them, the true place among them.
/// A place is the true one where it was right (0.5 m, 10 degrees) in most of its scans.
[[nodiscard]] std::vector<ReportTrack> hypothesis_tracks(const std::vector<BeliefRecord>& beliefs,
                                                         const score::Truth& truth, std::size_t most);

}  // namespace plumbline::scenarios
