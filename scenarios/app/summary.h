// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>

#include "bim/config/tree.h"
#include "scenarios/score/score_run.h"

namespace plumbline::scenarios {

/// A table of the methods with their verdicts and main metrics, a line a gate, and what came of it: the last line
/// says "gates: 3 of 4 passed" or "no gates".
[[nodiscard]] std::string summarise(const FinishedRun& run, const score::RunScore& score);

/// Links to the replay page, one for each method that failed a gate or went wrong unjudged; after a run that failed
/// also the command that stops there. Without the page: the command that writes it, where something went wrong.
[[nodiscard]] std::string next_steps(const std::string& dir, bool has_replay, const FinishedRun& run,
                                     const score::RunScore& score);

/// 0 all gates passed or none asked for, 1 a gate failed or a method crashed, 4 the scenario failed.
[[nodiscard]] int exit_code(const FinishedRun& run, const score::RunScore& score);

/// The graph files of a run's methods, by name.
[[nodiscard]] std::map<std::string, Tree> read_graphs(const std::string& dir, const FinishedRun& run);

/// Scores a run and writes results.json, junit.xml and report.html into `dir`. has_replay: whether replay.html stands
/// or will stand beside them, by the score.
[[nodiscard]] score::RunScore score_and_report(const std::string& dir, const FinishedRun& run,
                                               const std::function<bool(const score::RunScore&)>& has_replay);

}  // namespace plumbline::scenarios
