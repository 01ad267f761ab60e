// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bim/config/printable.h"
#include "bim/errors.h"
#include "scenarios/app/commands.h"
#include "scenarios/app/process.h"
#include "scenarios/app/summary.h"
#include "scenarios/host/files.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/host/manifest.h"
#include "scenarios/host/progress.h"
#include "scenarios/host/terminal.h"
#include "scenarios/report/replay/replay_page.h"
#include "scenarios/run/recorder.h"
#include "scenarios/run/run_files.h"
#include "scenarios/run/runner.h"
#include "scenarios/run/timings.h"
#include "slam/io/stopwatch.h"

namespace plumbline::scenarios {

namespace {

struct RunArguments {
  std::string input;
  std::vector<std::string> methods;
  std::uint64_t seed = 0;
  std::string out;
  int threads = 0;
  bool record = false;
  bool replay = false;
  bool force = false;
  std::optional<Argument> methods_option;
  std::optional<Argument> seed_option;
};

/// runs/<scenario>-<seed>, with what does not belong into a file name replaced.
std::string default_out(const Scenario& scenario) {
  std::string name = scenario.name;
  for (char& c : name) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
    if (!plain) c = '_';
  }
  return "runs/" + name + "-" + std::to_string(scenario.seed);
}

/// The commas between quotes of a command separate no methods.
std::vector<std::string> with_quotes_whole(const std::vector<std::string>& parts) {
  std::vector<std::string> methods;
  char quote = 0;
  for (const std::string& part : parts) {
    if (quote != 0)
      methods.back() += "," + part;
    else
      methods.push_back(part);
    for (const char c : part)
      if (quote == 0 ? c == '\'' || c == '"' : c == quote) quote = quote == 0 ? c : '\0';
  }
  return methods;
}

Overrides overrides_of(const RunArguments& options) {
  Overrides overrides;
  if (options.seed_option->given()) overrides.seed = options.seed;
  if (options.methods_option->given()) overrides.methods = with_quotes_whole(options.methods);
  if (!overrides.methods) return overrides;
  for (std::string& method : *overrides.methods)
    if (std::optional<ProcessSpec> process = process_of(method, std::filesystem::current_path().string())) {
      check_program(process->command, *process->folder, {"--method", 0, 0});
      method = process->name;
      overrides.processes.push_back(std::move(*process));
    }
  return overrides;
}

int run(const RunArguments& options, slam::MethodTable table) {
  const double start = slam::wall_s();
  const ResolvedScenario resolved = resolve(options.input, overrides_of(options), table);
  const std::string out = options.out.empty() ? default_out(resolved.scenario) : options.out;
  if (resolved.dropped_gates > 0)
    std::fprintf(stderr, "plumbline: --method leaves out methods with %d %s, not judged in this run\n",
                 resolved.dropped_gates, resolved.dropped_gates == 1 ? "gate" : "gates");

  catch_interrupts();
  RunDirectory directory(out, DirectoryKind::run, options.force);
  for (const std::string& note : walk_notes(resolved)) print_note(note);
  Progress progress(resolved.scenario.name, {resolved.scenario.duration_s, "s", true});
  const int threads = options.threads > 0 ? options.threads : allowed_cpus();
  RunOptions run_options;
  run_options.threads = threads;
  run_options.tick = [&](double t) { progress.at(t); };
  std::optional<Recorder> recorder;
  if (options.record) recorder.emplace(directory.staging() + "/" + std::string(recording_folder), resolved);
  ScanPacker scans = packer_of(resolved);
  run_options.observe = [&](const sim::WorldFrame& frame) {
    if (recorder) recorder->add(frame);
    scans.add(frame.sensors.scan);
  };
  RunRecord record = execute(resolved, run_options);
  if (record.truth_W.empty())
    throw ScenarioFailure(record.failure.empty() ? "the run ended before its first scan" : record.failure);

  progress.phase("scoring");
  write_run_files(directory.staging(), resolved, record);
  if (recorder) {
    recorder->finish();
    write_manifest(directory.staging() + "/" + std::string(recording_folder));
  }
  const FinishedRun finished = finished_run(resolved, std::move(record));
  const auto shows = [&](const score::RunScore& scored) { return options.replay || exit_code(finished, scored) != 0; };
  const score::RunScore score = score_and_report(directory.staging(), finished, shows);
  if (shows(score))
    write_file(directory.staging() + "/replay.html",
               render_replay(finished, score, scans, read_graphs(directory.staging(), finished)));
  check_interrupt();
  const RunCost cost{slam::wall_s() - start, slam::process_cpu_s(), score.duration_s, threads};
  write_file(directory.staging() + "/timings.json",
             write_timings(finished.record.sim_times, finished.record.methods, cost));
  directory.commit();

  if (!finished.record.failure.empty()) print_note(finished.record.failure);
  print("report: " + printable(out) + "/report.html\n" + summarise(finished, score) +
        next_steps(out, shows(score), finished, score));
  return exit_code(finished, score);
}

}  // namespace

Command add_run(CommandLine& program, slam::MethodTable table) {
  const auto options = std::make_shared<RunArguments>();
  CommandLine line = program.add_command("run", "Simulates a scenario, runs the methods, scores and reports them");
  line.option("INPUT", options->input,
              "scenario, plan or traffic-editor plan (.yaml), name of a scenario (plumbline scenarios), .ifc, or mesh "
              "(.glb, .obj, "
              ".dae, .ply, .stl)")
      .takes("SCENARIO")
      .required();
  options->methods_option =
      line.option(
              "--method", options->methods,
              "methods to run, comma-separated; NAME.lidar: with LiDAR alone; NAME=COMMAND: a process of your own [the "
              "scenario's]")
          .takes("METHOD")
          .delimiter(',');
  options->seed_option = line.seed("--seed", options->seed, "seed [the scenario's]");
  line.option("-o,--out", options->out, "run directory [runs/<scenario>-<seed>]").takes("DIR");
  line.option("--threads", options->threads, "threads [the CPUs allowed]").range(1, 1024);
  line.flag("--record", options->record, "also write the recording, as simulate does, into the folder recording");
  line.flag("--replay", options->replay,
            "also write replay.html, the run in three dimensions; a run that fails has it anyway");
  line.flag("--force", options->force, "replace the run that stands in --out");
  line.footer(
      "Example: plumbline run quickstart --out runs/first\n"
      "         plumbline run scenarios/library/quickstart.yaml --method vgicp,truth --seed 7 --out runs/seven");
  return {line, [options, table] { return run(*options, table); }};
}

}  // namespace plumbline::scenarios
