// SPDX-License-Identifier: Apache-2.0
#include "scenarios/shrink/shrink.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bim/config/printable.h"
#include "bim/errors.h"
#include "scenarios/app/commands.h"
#include "scenarios/app/process.h"
#include "scenarios/host/files.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/host/manifest.h"
#include "scenarios/host/progress.h"
#include "scenarios/host/terminal.h"
#include "scenarios/run/run_files.h"
#include "scenarios/shrink/shrink_text.h"
#include "scenarios/shrink/trial.h"
#include "scenarios/spec/scenario.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

namespace {

struct ShrinkArguments {
  std::string run;
  std::string method, gate;
  std::string out;
  std::vector<std::string> keep;
  int max_runs = 200;
  int jobs = 0;
  bool force = false;
  bool unchecked = false;
};

Tree results_in(const std::string& dir) {
  const std::string path = dir + "/results.json";
  if (!fs::exists(path)) throw InputError({dir, 0, 0}, "has no results.json; plumbline score DIR writes it");
  return read_json(read_text_file(path), path);
}

Shrunk search(const ShrinkArguments& options, const std::string& work) {
  const Tree results = results_in(options.run);
  const FailureSignature failure = chosen_failure(results, options.run, options.method, options.gate);
  Progress progress("shrink", {static_cast<double>(options.max_runs), "runs", true});
  ShrinkOptions shrinking{options.run, work, options.max_runs, options.jobs > 0 ? options.jobs : allowed_cpus(),
                          options.keep};
  shrinking.progress = [&](int runs) { progress.at(runs); };
  return shrink(read_case(options.run + "/scenario.yaml"), results, failure, shrinking);
}

/// An estimate that was scored beside the methods of the run cannot be made again.
void check_made_by_run(const FailureSignature& failure, const RunCase& run) {
  const std::vector<std::string> methods = read_scenario(write_yaml(run.scenario), "scenario.yaml").scenario.methods;
  if (std::find(methods.begin(), methods.end(), failure.method) == methods.end())
    throw InputError({"--method", 0, 0}, "'" + failure.method +
                                             "' is an outside estimate, which cannot be run again; name a method of "
                                             "the scenario");
}

/// The smallest run with all its files, which must fail the same way. What was found stays when this is interrupted.
void run_smallest(const std::string& staging, Shrunk& shrunk) {
  constexpr int gate_failed = 1;
  try {
    run_program_once({"run", staging + "/scenario.yaml", "--out", staging + "/run"}, {0, gate_failed});
  } catch (const Interrupted& interrupted) {
    fs::remove_all(staging + "/run");
    shrunk.end = ShrinkEnd::interrupted;
    shrunk.signal = interrupted.signal();
    return;
  }
  const std::string other = difference_to(shrunk.failure, results_in(staging + "/run"));
  if (!other.empty()) throw InternalError("the smallest run does not fail again: " + other);
}

int shrink_run(const ShrinkArguments& options) {
  check_run_directory(options.run);
  refuse_altered(options.run, altered_files(options.run, {{}, false}), options.unchecked);
  check_made_by_run(chosen_failure(results_in(options.run), options.run, options.method, options.gate),
                    read_case(options.run + "/scenario.yaml"));
  catch_interrupts();
  RunDirectory directory(options.out, DirectoryKind::shrink, options.force);
  const std::string work = directory.staging() + "/work";
  fs::create_directory(work);
  Shrunk shrunk = search(options, work);
  std::error_code error;
  fs::remove_all(work, error);
  if (shrunk.runs == 0) throw Interrupted(shrunk.signal);
  write_case(directory.staging(), shrunk.best);
  if (shrunk.end != ShrinkEnd::interrupted) run_smallest(directory.staging(), shrunk);
  write_file(directory.staging() + "/shrink.json", write_json(to_results(shrunk)) + "\n");
  directory.commit();
  if (shrunk.end == ShrinkEnd::interrupted)
    throw Interrupted(shrunk.signal, options.out + "/scenario.yaml is the smallest so far");
  print(shrink_text(shrunk) + "again: plumbline run " + shell_argument(options.out + "/scenario.yaml") + "\n" +
        "report: " + printable(options.out) + "/run/report.html\n");
  return 0;
}

}  // namespace

Command add_shrink(CommandLine& program) {
  const auto options = std::make_shared<ShrinkArguments>();
  CommandLine line = program.add_command("shrink", "Finds the smallest scenario and building that fail the same way");
  line.option("RUN", options->run, "run directory with a method that failed").takes("DIR").required();
  line.option("--method", options->method, "method whose failure is meant [that of the first failure]").takes("METHOD");
  line.option("--gate", options->gate, "metric of the failed gate that is meant [the first, or a bad verdict]")
      .takes("METRIC");
  line.option("-o,--out", options->out, "folder for the smallest scenario, new or empty").takes("DIR").required();
  line.option("--max-runs", options->max_runs, "greatest number of runs to try").range(1, 1'000'000).shows_default();
  line.option("--keep", options->keep, "what is left as it is, comma-separated")
      .one_of({shrink_stages.begin(), shrink_stages.end()})
      .delimiter(',');
  line.option("--jobs", options->jobs, "runs at a time; the result does not depend on it [the CPUs allowed]")
      .range(1, 1024);
  line.flag("--force", options->force, "replace what an earlier shrink left in --out");
  line.flag("--unchecked", options->unchecked, "goes on although files were altered since they were written");
  line.footer(
      "Example: plumbline shrink runs/alike -o runs/alike_small\n"
      "         plumbline shrink runs/night --method vgicp --gate ate_aligned_rmse_m -o runs/small");
  return {line, [options] { return shrink_run(*options); }};
}

}  // namespace plumbline::scenarios
