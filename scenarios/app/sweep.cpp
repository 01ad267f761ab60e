// SPDX-License-Identifier: Apache-2.0
#include "scenarios/sweep/sweep.h"

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "bim/config/printable.h"
#include "bim/errors.h"
#include "scenarios/app/commands.h"
#include "scenarios/app/process.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/host/progress.h"
#include "scenarios/host/terminal.h"
#include "scenarios/sweep/shared_simulation.h"
#include "scenarios/sweep/sweep_schema.h"

namespace plumbline::scenarios {

namespace {

struct SweepArguments {
  std::string file;
  std::string out;
  int jobs = 0;
  int seeds = 0;
  bool schema = false;
  std::vector<std::string> runs;  ///< what this program asks its children for: the runs of one simulation
  std::uint64_t seed = 1;
};

std::string run_with_progress(const Sweep& sweep, SweepOptions options) {
  Progress progress(sweep.file.name, {static_cast<double>(sweep.runs.size()), "runs"});
  options.progress = [&](std::size_t done, std::size_t) { progress.at(static_cast<double>(done)); };
  return run_sweep(sweep, options);
}

int sweep(const SweepArguments& options, slam::MethodTable table) {
  if (!options.runs.empty()) {
    constexpr int scenario_failed = 4;
    catch_interrupts();
    return run_shared(options.runs, options.seed, table) ? 0 : scenario_failed;
  }
  if (options.schema) {
    std::fputs(sweep_page().c_str(), stdout);
    return 0;
  }
  if (options.file.empty()) throw InputError({"SWEEP", 0, 0}, "is missing; name a sweep file");
  const Sweep sweep = read_sweep(options.file, options.seeds, table);
  std::string name = sweep.file.name;
  for (char& c : name)
    if (c == '/' || c == ' ') c = '_';
  SweepOptions run;
  run.out = options.out.empty() ? "sweeps/" + name : options.out;
  run.jobs = options.jobs > 0 ? options.jobs : allowed_cpus();
  run.resumed = [&](std::size_t done, std::size_t all) {
    print_note("plumbline: " + std::to_string(done) + " of " + std::to_string(all) + " runs are there already; " +
               run.out + "/results holds them, remove those to be made anew");
  };
  catch_interrupts();
  const std::string text = run_with_progress(sweep, run);
  print(text + "table: " + printable(run.out) + "/table.html\n");
  return 0;
}

}  // namespace

Command add_sweep(CommandLine& program, slam::MethodTable table) {
  const auto options = std::make_shared<SweepArguments>();
  CommandLine line = program.add_command("sweep", "Runs scenarios with many seeds and variants; makes one table");
  line.option("SWEEP", options->file, "sweep file (.yaml)");
  line.option("-o,--out", options->out, "folder of the sweep, new or to be resumed [sweeps/<name>]");
  line.option("--jobs", options->jobs, "runs at a time [the CPUs allowed]").range(1, 1024);
  line.option("--seeds", options->seeds, "number of seeds, in place of the file's; runs that are there are kept")
      .range(1, 100000);
  line.flag("--schema", options->schema, "prints instead every key of sweep files, with examples");
  line.option("--runs", options->runs,
              "scenarios that differ in prior, methods, sensors and gates alone, to be run on one simulation")
      .hidden();
  line.seed("--seed", options->seed, "their seed").hidden();
  line.footer(
      "Example: plumbline sweep ci/sweeps/look.yaml --jobs 2\nA sweep that was stopped is resumed by the same "
      "command.");
  return {line, [options, table] { return sweep(*options, table); }};
}

}  // namespace plumbline::scenarios
