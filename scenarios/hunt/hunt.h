// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/hunt/blame.h"
#include "scenarios/hunt/hunt_file.h"
#include "scenarios/hunt/sampling.h"
#include "scenarios/shrink/run_case.h"
#include "scenarios/shrink/trial.h"

namespace plumbline::scenarios {

/// One run of a hunt.
struct HuntRun {
  std::size_t base = 0;
  Point point;
  std::uint64_t seed = 0;
  std::optional<std::size_t> near;                               ///< the run that it was drawn near to
  std::vector<std::pair<std::string, std::string>> values = {};  ///< what was drawn, by key
  std::optional<RunCase> run = {};  ///< nothing where the draw gave none; its building is kept of findings alone
  bool begun = false;               ///< it was resolved, and its walk began
  bool alone = false;               ///< each method by itself, since all together ended the program
  std::string why = {};             ///< where it could not be made or its walk failed, why
  std::vector<MethodOutcome> outcomes = {};
  double badness = 0.0;  ///< the greatest of its methods
};

/// Runs that failed alike, by a method's fault.
struct HuntFinding {
  FailureSignature failure;              ///< of the worst of them
  std::vector<std::string> ingredients;  ///< keys, without values
  std::size_t worst = 0;                 ///< run
  std::vector<std::size_t> runs;
  double badness = 0.0;
};

struct HuntResult {
  std::vector<HuntRun> runs;
  std::vector<HuntFinding> findings;   ///< the worst first
  std::map<std::string, int> excused;  ///< failures that are not a method's fault, by reason
  int signal = 0;                      ///< that interrupted it
};

struct HuntOptions {
  std::string work;  ///< folder for what is tried, which is there
  int jobs = 1;      ///< decides about time alone
  std::function<void(int runs)> progress = {};
  TryCases try_all = {};  ///< in place of in_processes()
};

/// Makes the runs of a hunt: the first ones all over the ranges, the others in generations near the worst so far.
/// Throws InputError where no walk begins.
[[nodiscard]] HuntResult run_hunt(const Hunt& hunt, const HuntOptions& options, slam::MethodTable table);

/// The worst run of a finding, which `plumbline run` repeats.
[[nodiscard]] RunCase case_of(const HuntResult& result, const HuntFinding& finding);
/// Whether a walk ended, so that there is something to judge.
[[nodiscard]] bool any_walked(const HuntResult& result);

/// Findings and excuses of runs that are made.
void summarize(HuntResult& result);

}  // namespace plumbline::scenarios
