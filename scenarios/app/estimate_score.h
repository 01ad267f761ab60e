// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scenarios/spec/scenario.h"

namespace plumbline::scenarios {

/// Whether `plumbline estimate` wrote this directory.
[[nodiscard]] bool is_estimate_directory(const std::string& dir);

/// Files of the recording that `plumbline estimate --unchecked` took although they had been altered.
[[nodiscard]] std::vector<std::string> unchecked_by_estimate(const std::string& dir);

/// Scores what `plumbline estimate` left by itself and, where `reference` is FILE or BAG,topic=TOPIC, by that
/// trajectory; a localization also in the plan's frame, where ",frame=W" says that the reference is. Writes score.json,
/// reference.tum and the page into `dir` and prints a table. Throws InputError, also where the two are of different
/// times, and, unless `unchecked`, where files were altered since they were written. A gate names a value of
/// score.json: as causal has it, "final.NAME", or one at the top; it fails where that is absent, and where fewer than
/// 95 % of the scans have a pose or of the poses lie within the reference; of localization.NAME where the reference
/// covers fewer of the scans. Returns the exit code.
[[nodiscard]] int score_estimate(const std::string& dir, const std::string& reference,
                                 const std::vector<GateSpec>& gates, bool unchecked);

}  // namespace plumbline::scenarios
