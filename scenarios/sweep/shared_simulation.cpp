// SPDX-License-Identifier: Apache-2.0
#include "scenarios/sweep/shared_simulation.h"

#include <filesystem>
#include <utility>

#include "bim/digest/digest.h"
#include "bim/errors.h"
#include "scenarios/host/files.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/host/terminal.h"
#include "scenarios/run/finished_run.h"
#include "scenarios/run/runner.h"
#include "scenarios/score/score_run.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

namespace {

/// One of the runs, with its methods.
class SharedRun {
 public:
  SharedRun(const std::string& file, ResolvedScenario resolved)
      : dir_(fs::path(file).replace_extension().string()),
        resolved_(std::move(resolved)),
        methods_(make_methods(resolved_)) {}

  [[nodiscard]] const ResolvedScenario& resolved() const { return resolved_; }

  void on_frame(const sim::WorldFrame& frame) {
    for (const auto& method : methods_.estimators) method->on_frame(frame.sensors);
    if (methods_.oracle) methods_.oracle->on_truth(frame.truth);
  }

  /// `simulated`: what the simulation left, without methods.
  void score(RunRecord simulated) {
    std::vector<MethodRecord> estimated;
    for (const auto& method : methods_.estimators) {
      check_interrupt();
      estimated.push_back(method->finish());
    }
    methods_.estimators.clear();
    simulated.methods = methods_.finish(resolved_.scenario, std::move(estimated));
    std::vector<DigestLog> logs = {std::move(simulated.digests)};
    for (const MethodRecord& method : simulated.methods) logs.push_back(method.digests);
    simulated.digests = merge_logs(logs);
    std::error_code error;
    fs::create_directory(dir_, error);
    if (error) throw EnvironmentError(dir_ + ": cannot be created: " + error.message());
    const FinishedRun run = finished_run(resolved_, std::move(simulated));
    Tree digests = Tree::map();
    for (const auto& [part, digest] : digests_by_part(run.record.digests)) digests.set(part, hex64(digest));
    write_file(dir_ + "/digests.json", write_json(digests) + "\n");
    write_file(dir_ + "/results.json", score::write_results(run, score::score_run(run)));
  }

 private:
  std::string dir_;
  ResolvedScenario resolved_;
  RunMethods methods_;
};

std::vector<SharedRun> make_runs(const std::vector<std::string>& files, std::uint64_t seed, slam::MethodTable table) {
  std::vector<SharedRun> runs;
  runs.reserve(files.size());
  for (const std::string& file : files) {
    ResolvedScenario resolved = resolve(file, {std::nullopt, seed}, table);
    if (!runs.empty()) resolved.building = runs.front().resolved().building;  // the same one, with its plans and meshes
    runs.emplace_back(file, std::move(resolved));
  }
  return runs;
}

}  // namespace

bool run_shared(const std::vector<std::string>& files, std::uint64_t seed, slam::MethodTable table) {
  if (files.empty()) throw InternalError("no runs to share a simulation");
  std::vector<SharedRun> runs = make_runs(files, seed, table);
  RunOptions options;
  options.methods = false;
  options.observe = [&](const sim::WorldFrame& frame) {
    for (SharedRun& run : runs) run.on_frame(frame);
  };
  const RunRecord simulated = execute(runs.front().resolved(), options);
  if (simulated.truth_W.empty())
    throw ScenarioFailure(simulated.failure.empty() ? "the run ended before its first scan" : simulated.failure);
  for (SharedRun& run : runs) run.score(simulated);
  if (!simulated.failure.empty()) print_note(simulated.failure);
  return simulated.failure.empty();
}

}  // namespace plumbline::scenarios
