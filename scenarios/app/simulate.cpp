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
  bool mcap = false;
  bool rosbag2 = false;
  std::string compression = "none";
  bool bag_truth = false;
  std::string profile = "velodyne";
  std::optional<Argument> seed_option;
  std::optional<Argument> profile_option;
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

/// What is of bags says nothing where none is written.
void check_bag_options(const SimulateArguments& options) {
  if (options.bag || options.mcap || options.rosbag2) return;
  if (options.profile_option->given() || options.bag_truth)
    throw InputError({options.bag_truth ? "--bag-truth" : "--ros-profile", 0, 0},
                     "is of bags; --bag, --mcap or --rosbag2 is to be given with it");
}

int simulate(const SimulateArguments& options, slam::MethodTable table) {
  check_bag_options(options);
  Overrides overrides;
  if (options.seed_option->given()) overrides.seed = options.seed;
  const ResolvedScenario resolved = resolve(options.input, overrides, table);
  for (const std::string& note : walk_notes(resolved)) print_note(note);

  catch_interrupts();
  RunDirectory directory(options.out, DirectoryKind::recording, options.force);
  const std::string& dir = directory.staging();
  const bool to_bag = options.bag || options.mcap || options.rosbag2;
  Recorder recorder(dir, resolved, to_bag);
  const slam::BagProfile& profile = find_profile(options.profile);
  if (options.bag) recorder.add_bag(profile, options.bag_truth);
  if (options.mcap)
    recorder.add_bag(profile, options.bag_truth, slam::BagFormat::mcap,
                     options.compression == "none" ? "" : options.compression);
  if (options.rosbag2) recorder.add_bag(profile, options.bag_truth, slam::BagFormat::rosbag2);
  recorder.add_building(resolved);
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
      program.add_command("simulate", "Records the sensor data of a walk; true poses go into a separate file");
  line.option("INPUT", options->input, "scenario, plan or building, as for run").takes("SCENARIO").required();
  line.option("-o,--out", options->out, "directory to write").takes("DIR").required();
  options->seed_option = line.seed("--seed", options->seed, "seed [the scenario's]");
  line.flag("--bag", options->bag, "also write recording.bag (ROS 1, LZ4)");
  const Argument mcap = line.flag("--mcap", options->mcap, "also write recording.mcap (ROS 2)");
  line.flag("--rosbag2", options->rosbag2, "also write the folder rosbag2 (ROS 2, SQLite, as Humble)");
  line.option("--compression", options->compression, "of the MCAP file's chunks")
      .one_of({"none", "zstd", "lz4"})
      .shows_default()
      .needs(mcap);
  options->profile_option =
      line.option("--ros-profile", options->profile, "topics, frames and cloud layout of the bags")
          .one_of(profile_names())
          .shows_default();
  line.flag("--bag-truth", options->bag_truth, "true poses in the bags, on /ground_truth/odom");
  line.flag("--force", options->force, "replace the recording that stands in --out");
  line.footer(
      "Example: plumbline simulate scenarios/library/house.yaml -o walk --bag\n"
      "         plumbline simulate scenarios/library/house.yaml -o walk --mcap --bag-truth\n"
      "Writes lidar.pcap (packets of the LiDAR), odometry.tum, odometry_covariance.csv, imu.csv, recording.yaml and "
      "truth.tum; plumbline "
      "estimate "
      "reads all but the last.");
  return {line, [options, table] { return simulate(*options, table); }};
}

}  // namespace plumbline::scenarios
