// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "bim/errors.h"
#include "bim/formats/plan_yaml/plan_write.h"
#include "bim/generators/generators.h"
#include "scenarios/app/bench/bench.h"
#include "scenarios/app/bench/child.h"
#include "scenarios/host/files.h"
#include "scenarios/run/runner.h"

namespace plumbline::scenarios {

namespace {

namespace fs = std::filesystem;

struct SimLimits {
  double physics_realtime_factor = 12.0;
  double realtime_factor = 6.0;
  double memory_mb = 300.0;
};

struct SimConfig {
  int rows = 10;  ///< of the grid of equal rooms that is walked in,
  int columns = 10;
  double seconds = 30.0;  ///< of simulated time, a repetition
};

/// A folder for files that go away with this.
class ScratchFolder {
 public:
  ScratchFolder() : path_((fs::temp_directory_path() / "plumbline-bench-XXXXXX").string()) {
    if (mkdtemp(path_.data()) == nullptr) throw EnvironmentError("bench: no folder can be made at " + path_);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] std::string operator/(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

/// Writes plan and scenario of the walk; gives the scenario's path.
std::string write_walk(const ScratchFolder& folder, const SimConfig& config) {
  Tree options = Tree::map();
  options.set("rows", std::to_string(config.rows)).set("columns", std::to_string(config.columns));
  const bim::GeneratedPlan generated = bim::generate("grid", options);
  write_file(folder / "grid.plan.yaml", bim::write_plan(generated.plan));
  Scenario scenario;
  scenario.name = "grid";
  scenario.building = "grid.plan.yaml";
  scenario.start.room = generated.start;
  scenario.route.rooms = generated.rooms;
  scenario.duration_s = config.seconds;
  scenario.methods = {"truth"};
  write_file(folder / "grid.yaml", write_scenario(scenario));
  return folder / "grid.yaml";
}

struct Factors {
  double physics = 0.0;
  double all = 0.0;
};

/// Simulated seconds per CPU second: of the physics alone, and with the LiDAR and its packets.
Factors realtime_factors(const std::string& scenario, std::uint64_t seed) {
  Overrides overrides;
  overrides.seed = seed;
  const ResolvedScenario resolved = resolve(scenario, overrides);
  RunOptions options;
  options.methods = false;
  double physics_ms = 0.0, all_ms = 0.0, simulated_s = 0.0;
  options.observe = [&](const sim::WorldFrame& frame) {
    for (const slam::StageTime& time : frame.times) {
      all_ms += time.cpu_ms;
      if (time.stage == "sim.physics") physics_ms += time.cpu_ms;
    }
    simulated_s = slam::seconds(frame.sensors.scan.stamp);
  };
  const RunRecord record = execute(resolved, options);
  if (!record.failure.empty()) throw ScenarioFailure("bench: " + record.failure);
  return {1e3 * simulated_s / physics_ms, 1e3 * simulated_s / all_ms};
}

}  // namespace

std::vector<BenchRow> bench_sim(const BenchSetting& setting) {
  const SimConfig config;
  const SimLimits limits;
  const ScratchFolder folder;
  const std::string scenario = write_walk(folder, config);
  std::vector<double> physics, all, memory;
  for (int k = 1; k <= setting.repetitions; ++k) {
    setting.step();
    const Factors factors = realtime_factors(scenario, static_cast<std::uint64_t>(k));
    physics.push_back(factors.physics);
    all.push_back(factors.all);
    memory.push_back(run_self({"simulate", scenario, "--force", "-o", folder / "recording"}).peak_rss_mb);
  }
  const std::string rooms = std::to_string(config.rows * config.columns);
  return {make_row("sim.physics_realtime_factor", "x", physics, BenchLimit{limits.physics_realtime_factor, false}),
          make_row("sim.realtime_factor", "x", all, BenchLimit{limits.realtime_factor, false}),
          make_row("sim.memory_" + rooms + "_rooms_mb", "MB", memory, BenchLimit{limits.memory_mb})};
}

}  // namespace plumbline::scenarios
