// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scenarios/run/finished_run.h"

namespace plumbline::scenarios {

/// Writes everything but scores and report into `dir`: building, scenario.yaml, digests.csv, truth.tum,
/// truth_surface.ply, and of each method <method>.tum, .final.tum, .estimate.json, .map.ply, .map.pcd, .graph.json,
/// .hypotheses.jsonl (the last four where there is something to say), failure.txt where the scenario failed. Throws
/// EnvironmentError.
void write_run_files(const std::string& dir, const ResolvedScenario& resolved, const RunRecord& record);

/// Throws InputError on what is no run directory.
void check_run_directory(const std::string& dir);
/// Reads a run directory. Throws InputError at the file and line that is missing or damaged.
[[nodiscard]] FinishedRun read_run(const std::string& dir);

/// The oracle leaves no files but its estimate: what it knows stands in truth.tum and truth_surface.ply.
[[nodiscard]] bool is_oracle(const MethodRecord& method);
/// Sets what the oracle answers from the truth of its run.
void give_truth(const RunRecord& run, MethodRecord& oracle);

/// Writes the files of one method.
void write_method(const std::string& dir, const MethodRecord& method);
/// Removes them.
void remove_method(const std::string& dir, const std::string& name);
/// Names that they may have.
[[nodiscard]] std::vector<std::string> files_of_method(const std::string& name);
/// Reads them. Throws InputError.
[[nodiscard]] MethodRecord read_method(const std::string& dir, const std::string& name);
/// Methods with an estimate in `dir`, by name.
[[nodiscard]] std::vector<std::string> estimates_in(const std::string& dir);

}  // namespace plumbline::scenarios
