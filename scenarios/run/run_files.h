// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/load/load.h"
#include "scenarios/run/record.h"
#include "scenarios/spec/resolve.h"

namespace plumbline::scenarios {

/// What a run directory holds, as far as scoring and the report need it.
struct RunFiles {
  std::string dir;
  Scenario scenario;
  bim::Site site;
  DigestLog digests;
  std::vector<slam::Nanoseconds> scans;  ///< stamps of all scans
  std::vector<slam::StampedPose> truth_W;
  std::vector<Eigen::Vector3f> surface_W;
  std::vector<MethodRecord> methods;  ///< the scenario's in its order, then outside trajectories by name
  std::string failure;                ///< why the scenario ended early, or empty
};

/// Writes everything but scores and report into `dir`: building, scenario.yaml, digests.csv, truth.tum,
/// truth_surface.ply, and of each method <method>.tum, .final.tum, .estimate.json, .map.ply, .map.pcd, .graph.json,
/// .hypotheses.jsonl (the last four where there is something to say), failure.txt where the scenario failed. Throws
/// EnvironmentError.
void write_run_files(const std::string& dir, const ResolvedScenario& resolved, const RunRecord& record);

/// Throws InputError on what is no run directory.
void check_run_directory(const std::string& dir);
/// Reads a run directory. Throws InputError at the file and line that is missing or damaged.
[[nodiscard]] RunFiles read_run_files(const std::string& dir);

/// Writes the files of one method.
void write_method(const std::string& dir, const MethodRecord& method);
/// Removes them.
void remove_method(const std::string& dir, const std::string& name);
/// Reads them. Throws InputError.
[[nodiscard]] MethodRecord read_method(const std::string& dir, const std::string& name);
/// Methods with an estimate in `dir`, by name.
[[nodiscard]] std::vector<std::string> estimates_in(const std::string& dir);

}  // namespace plumbline::scenarios
