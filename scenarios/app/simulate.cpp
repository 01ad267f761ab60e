// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bim/config/printable.h"
#include "bim/errors.h"
#include "scenarios/app/commands.h"
#include "scenarios/host/files.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/host/progress.h"
#include "scenarios/host/terminal.h"
#include "scenarios/run/recorder.h"
#include "scenarios/run/runner.h"
#include "slam/io/recordings/tum.h"

namespace plumbline::scenarios {

namespace {

struct SimulateArguments {
  std::string input;
  std::string out;
  std::uint64_t seed = 0;
  bool force = false;
  bool bag = false;
  bool bag_truth = false;
  std::string profile = "velodyne";
  std::optional<Argument> seed_option;
};

std::vector<std::string> profile_names() {
  std::vector<std::string> names;
  for (const slam::BagProfile& profile : slam::bag_profiles) names.emplace_back(profile.name);
  return names;
}

const slam::BagProfile& find_profile(const std::string& name) {
  const auto& rows = slam::bag_profiles;
  return *std::find_if(rows.begin(), rows.end(), [&](const slam::BagProfile& row) { return row.name == name; });
}

int simulate(const SimulateArguments& options, slam::MethodTable table) {
  Overrides overrides;
  if (options.seed_option->given()) overrides.seed = options.seed;
  const ResolvedScenario resolved = resolve(options.input, overrides, table);

  catch_interrupts();
  RunDirectory directory(options.out, DirectoryKind::recording, options.force);
  const std::string& dir = directory.staging();
  Recorder recorder(dir, resolved, options.bag);
  if (options.bag) recorder.add_bag(find_profile(options.profile), options.bag_truth);
  RunOptions run_options;
  run_options.methods = false;
  run_options.observe = [&](const sim::WorldFrame& frame) { recorder.add(frame); };
  RunRecord record;
  {
    Progress progress(resolved.scenario.name, {resolved.scenario.duration_s, "s", true});
    run_options.tick = [&](double t) { progress.at(t); };
    record = execute(resolved, run_options);
  }
  if (record.truth_W.empty())
    throw ScenarioFailure(record.failure.empty() ? "the run ended before its first scan" : record.failure);
  recorder.finish();
  write_file(dir + "/truth.tum", slam::write_tum(record.truth_W));
  write_file(dir + "/" + resolved.scenario.building, resolved.building_bytes);
  write_file(dir + "/scenario.yaml", write_scenario(resolved.scenario));
  directory.commit();

  print("recording: " + printable(options.out) + " (" + slam::format_stamp(record.truth_W.back().stamp) + " s)\n");
  if (record.failure.empty()) return 0;
  throw ScenarioFailure(record.failure);
}

}  // namespace

Command add_simulate(CommandLine& program, slam::MethodTable table) {
  const auto options = std::make_shared<SimulateArguments>();
  CommandLine line =
      program.add_command("simulate", "Records the sensor data of a walk, and the true poses in a file apart");
  line.option("INPUT", options->input, "scenario, plan or building, as for run").required();
  line.option("-o,--out", options->out, "directory to write").required();
  options->seed_option = line.seed("--seed", options->seed, "seed [the scenario's]");
  const Argument bag = line.flag("--bag", options->bag, "also write recording.bag (ROS 1, LZ4)");
  line.option("--ros-profile", options->profile, "topics, frames and cloud layout of the bag")
      .one_of(profile_names())
      .shows_default()
      .needs(bag);
  line.flag("--bag-truth", options->bag_truth, "true poses in the bag, on /ground_truth/odom").needs(bag);
  line.flag("--force", options->force, "replace the recording that stands in --out");
  line.footer(
      "Example: plumbline simulate scenarios/library/house.yaml -o walk --bag\n"
      "Writes lidar.pcap (packets of the LiDAR), odometry.tum, odometry_covariance.csv, imu.csv, recording.yaml and "
      "truth.tum; plumbline "
      "estimate "
      "reads all but the last.");
  return {line, [options, table] { return simulate(*options, table); }};
}

}  // namespace plumbline::scenarios
