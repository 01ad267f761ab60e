// SPDX-License-Identifier: Apache-2.0
#include "scenarios/sweep/shared_walk.h"

#include <cstdio>
#include <filesystem>

#include "bim/errors.h"
#include "scenarios/host/files.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/run/run_files.h"
#include "scenarios/run/runner.h"
#include "scenarios/score/score_run.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

namespace {

/// One of the runs, with its methods.
class Listener {
 public:
  Listener(const std::string& file, std::uint64_t seed, slam::MethodTable table)
      : dir_(fs::path(file).replace_extension().string()),
        resolved_(resolve(file, {std::nullopt, seed}, table)),
        participants_(make_participants(resolved_)) {}

  [[nodiscard]] const ResolvedScenario& resolved() const { return resolved_; }

  void on_frame(const sim::WorldFrame& frame) {
    for (const auto& participant : participants_) participant->on_frame(frame);
  }

  /// `walk`: what the simulation left, without methods.
  void score(RunRecord walk) {
    std::vector<DigestLog> logs = {std::move(walk.digests)};
    for (const auto& participant : participants_) {
      check_interrupt();
      logs.push_back(walk.methods.emplace_back(participant->finish()).digests);
    }
    participants_.clear();
    walk.digests = merge_logs(logs);
    std::error_code error;
    fs::create_directory(dir_, error);
    if (error) throw EnvironmentError(dir_ + ": cannot be created: " + error.message());
    write_run_files(dir_, resolved_, walk);
    const RunFiles files = read_run_files(dir_);
    write_file(dir_ + "/results.json", score::write_results(files, score::score_run(files)));
  }

 private:
  std::string dir_;
  ResolvedScenario resolved_;
  std::vector<std::unique_ptr<Participant>> participants_;
};

}  // namespace

bool run_shared(const std::vector<std::string>& files, std::uint64_t seed, slam::MethodTable table) {
  if (files.empty()) throw InternalError("no runs to share a walk");
  std::vector<Listener> listeners;
  listeners.reserve(files.size());
  for (const std::string& file : files) listeners.emplace_back(file, seed, table);
  RunOptions options;
  options.methods = false;
  options.sensors = [&](const sim::WorldFrame& frame) {
    for (Listener& listener : listeners) listener.on_frame(frame);
  };
  const RunRecord walk = execute(listeners.front().resolved(), options);
  if (walk.truth_W.empty())
    throw ScenarioFailure(walk.failure.empty() ? "the run ended before its first scan" : walk.failure);
  for (Listener& listener : listeners) listener.score(walk);
  if (!walk.failure.empty()) std::fprintf(stderr, "%s\n", walk.failure.c_str());
  return walk.failure.empty();
}

}  // namespace plumbline::scenarios
