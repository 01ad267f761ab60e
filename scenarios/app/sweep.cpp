// SPDX-License-Identifier: Apache-2.0
#include "scenarios/sweep/sweep.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
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
#include "scenarios/sweep/slurm.h"
#include "scenarios/sweep/sweep_schema.h"

namespace plumbline::scenarios {

namespace {

struct SweepArguments {
  std::string file;
  std::string out;
  int jobs = 0;
  int seeds = 0;
  bool schema = false;
  std::string shard;
  bool slurm = false;
  std::vector<std::string> pages;
  int runs_per_task = 20;
  std::vector<std::string> runs;  ///< what this program asks its children for: the runs of one simulation
  std::uint64_t seed = 1;
};

SweepTables run_with_progress(const Sweep& sweep, SweepOptions options) {
  Progress progress(sweep.file.name, {static_cast<double>(sweep.runs.size()), "runs"});
  options.progress = [&](std::size_t done, std::size_t) { progress.at(static_cast<double>(done)); };
  return run_sweep(sweep, options);
}

struct CollectArguments {
  std::string file;
  std::vector<std::string> from;
  std::string out;
  int seeds = 0;
};

/// What is said of tables that stand in `out`. Throws InputError where runs of it were refused, EnvironmentError
/// where some broke the program.
int tell(const SweepTables& tables, const std::string& file, const std::string& out) {
  print(tables.text + "table: " + printable(out) + "/table.html\n");
  for (const std::string& note : tables.notes) print_note("plumbline: warning: " + printable(note));
  if (!tables.refused.empty()) throw InputError({file, 0, 0}, tables.refused);
  if (!tables.broken.empty()) throw EnvironmentError(file + ": " + tables.broken);
  return 0;
}

std::string default_out(const Sweep& sweep) {
  std::string name = sweep.file.name;
  for (char& c : name)
    if (c == '/' || c == ' ') c = '_';
  return "sweeps/" + name;
}

/// "I/N", with I from 1 to N.
Shard shard_of(const std::string& text) {
  Shard shard;
  int end = 0;
  constexpr int most = 1'000'000;
  const bool read = std::sscanf(text.c_str(), "%d/%d%n", &shard.number, &shard.of, &end) == 2 &&
                    static_cast<std::size_t>(end) == text.size();
  if (!read || shard.of < 1 || shard.of > most || shard.number < 1 || shard.number > shard.of)
    throw InputError({"--shard", 0, 0}, "'" + text + "' must be I/N, with I from 1 to N, as in 2/8");
  return shard;
}

/// Words of the command line that a part of the sweep is to be asked with.
std::vector<std::string> words_of(const std::string& file, int seeds) {
  std::vector<std::string> words = {std::filesystem::absolute(file).lexically_normal().string()};
  if (seeds > 0) words.insert(words.end(), {"--seeds", std::to_string(seeds)});
  return words;
}

int submit_to_slurm(const SweepArguments& options, const Sweep& sweep) {
  SlurmJob job;
  job.name = sweep.file.name;
  for (char& c : job.name)
    if (c <= ' ' || c == '/' || c == ',') c = '_';
  std::error_code error;
  job.program = std::filesystem::read_symlink("/proc/self/exe", error).string();
  job.sweep = words_of(options.file, options.seeds);
  const std::string out = options.out.empty() ? default_out(sweep) : options.out;
  job.out = std::filesystem::absolute(out).lexically_normal().string();
  const auto runs = static_cast<int>(sweep.runs.size());
  job.shards = std::clamp((runs + options.runs_per_task - 1) / options.runs_per_task, 1, walks_of(sweep));
  job.at_once = options.jobs;
  print(submit(job));
  return 0;
}

int collect(const CollectArguments& options, slam::MethodTable table) {
  const Sweep sweep = read_sweep(options.file, options.seeds, table);
  const std::string out = options.out.empty() ? default_out(sweep) : options.out;
  return tell(collect_sweep(sweep, options.from, out), options.file, out);
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
  if (options.file.empty()) throw InputError({"SWEEP", 0, 0}, "is required: a sweep file; see plumbline sweep --help");
  const Sweep sweep = read_sweep(options.file, options.seeds, table);
  for (const std::string& note : sweep.notes) print_note("plumbline: warning: " + note);
  if (options.slurm) {
    if (!options.shard.empty()) throw InputError({"--shard", 0, 0}, "is chosen by the cluster with --slurm");
    return submit_to_slurm(options, sweep);
  }
  SweepOptions run;
  run.out = options.out.empty() ? default_out(sweep) : options.out;
  if (!options.shard.empty()) {
    run.shard = shard_of(options.shard);
    if (options.out.empty()) run.out = shard_folder(run.out, run.shard->number, run.shard->of);
  }
  run.jobs = options.jobs > 0 ? options.jobs : allowed_cpus();
  run.pages = options.pages;
  if (run.shard && !run.pages.empty())
    throw InputError({"--page", 0, 0}, "is of a whole sweep; a shard makes no tables");
  run.resumed = [&](std::size_t done, std::size_t all) {
    print_note("plumbline: " + std::to_string(done) + " of " + std::to_string(all) + " runs are there already; " +
               run.out + "/results holds them, remove those to be made anew");
  };
  catch_interrupts();
  const SweepTables tables = run_with_progress(sweep, run);
  if (!run.shard) return tell(tables, options.file, run.out);
  print(tables.text + "results: " + printable(run.out) + "/results\n");
  if (!tables.refused.empty()) throw InputError({options.file, 0, 0}, tables.refused);
  return 0;
}

}  // namespace

Command add_sweep(CommandLine& program, slam::MethodTable table) {
  const auto options = std::make_shared<SweepArguments>();
  CommandLine line = program.add_command("sweep", "Runs scenarios with many seeds and variants; makes one table");
  line.option("SWEEP", options->file, "sweep file (.yaml)");
  line.option("-o,--out", options->out, "folder of the sweep, new or to be resumed [sweeps/<name>]").takes("DIR");
  line.option("--jobs", options->jobs, "runs at a time [the CPUs allowed]").range(1, 1024);
  line.option("--seeds", options->seeds, "number of seeds, in place of the file's; runs that are there are kept")
      .range(1, 100000);
  line.flag("--schema", options->schema, "prints instead every key of sweep files, with examples");
  line.option("--shard", options->shard,
              "I/N: only part I of N, for one of N machines; sweep collect makes the table of all parts");
  line.option(
          "--page", options->pages,
          "makes a run again, with its report and replay page, in OUT/pages/RUN; RUN as table.html names it, or worst")
      .takes("RUN");
  line.flag("--slurm", options->slurm,
            "submits the sweep to Slurm as an array of shards, --jobs tasks at a time, and a job that collects them");
  line.option("--runs-per-task", options->runs_per_task,
              "with --slurm: runs that a task has at least, so that it lasts ten minutes or more [20]")
      .range(1, 100000);
  line.option("--runs", options->runs,
              "scenarios that differ in prior, methods, sensors and gates alone, to be run on one simulation")
      .hidden();
  line.seed("--seed", options->seed, "their seed").hidden();
  const auto collected = std::make_shared<CollectArguments>();
  CommandLine collector = line.add_command("collect", "makes the table of a sweep from what its shards left");
  collector.option("SWEEP", collected->file, "sweep file (.yaml)").required();
  collector.option("--from", collected->from, "folders that sweep --shard wrote").takes("DIR").required();
  collector.option("-o,--out", collected->out, "folder of the sweep, new or to be completed [sweeps/<name>]")
      .takes("DIR");
  collector.option("--seeds", collected->seeds, "as given to the shards").range(1, 100000);
  collector.footer("Example: plumbline sweep collect look.yaml --from sweeps/look.shards/* -o sweeps/look");
  line.footer(
      "Example: plumbline sweep ci/sweeps/look.yaml --jobs 2\n"
      "         plumbline sweep look.yaml --shard 2/8\n"
      "         parallel -S host1,host2 --wd . plumbline sweep look.yaml --shard {}/8 ::: {1..8}\n"
      "         plumbline sweep look.yaml --slurm --jobs 50\n"
      "A sweep or shard that was stopped is resumed by the same command.");
  return {line, [options, collected, collector, table] {
            return collector.asked() ? collect(*collected, table) : sweep(*options, table);
          }};
}

}  // namespace plumbline::scenarios
