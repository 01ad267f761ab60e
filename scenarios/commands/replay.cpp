// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "scenarios/commands/commands.h"
#include "scenarios/commands/process.h"
#include "scenarios/run/interrupt.h"
#include "scenarios/run/progress.h"
#include "scenarios/run/runner.h"
#include "slam/io/tum.h"

namespace plumbline::scenarios {

namespace {

struct Options {
  std::string dir;
  double until_s = 0.0;
  int threads = 0;
  CLI::Option* until_option = nullptr;
};

/// Leaves out what comes after `until`, and the answers at the end of a run, which a shorter one gives earlier.
DigestLog cut(DigestLog log, const std::optional<double>& until_s) {
  if (!until_s) return log;
  const auto last = static_cast<slam::Nanoseconds>(std::llround(*until_s * 1e9));
  std::erase_if(log, [&](const DigestEntry& entry) { return entry.tick > last || entry.stage.ends_with("/estimate"); });
  return log;
}

int replay(const Options& options, slam::MethodTable table) {
  const std::string path = options.dir + "/digests.csv";
  const DigestLog recorded = read_digests(read_text_file(path), path);
  const ResolvedScenario resolved = resolve(options.dir + "/scenario.yaml", {}, table);
  RunOptions run_options;
  run_options.threads = options.threads > 0 ? options.threads : allowed_cpus();
  if (options.until_option->count() > 0) run_options.until_s = options.until_s;

  catch_interrupts();
  RunRecord record;
  {
    Progress progress("replay", run_options.until_s.value_or(resolved.scenario.duration_s));
    run_options.tick = [&](double t) { progress.at(t); };
    record = execute(resolved, run_options);
  }
  const DigestLog again = cut(record.digests, run_options.until_s);
  const auto difference = first_difference(cut(recorded, run_options.until_s), again);
  if (!difference) {
    std::printf("equal: %zu digests\n", again.size());
    return 0;
  }
  std::printf("first difference at %s s in %s: %s (the first is the recorded run)\n",
              slam::format_stamp(difference->tick).c_str(), difference->stage.c_str(), difference->what.c_str());
  return 1;
}

}  // namespace

Command add_replay(CLI::App& program, slam::MethodTable table) {
  const auto options = std::make_shared<Options>();
  CLI::App* app = program.add_subcommand("replay", "Runs a run directory again and compares every digest");
  app->add_option("DIR", options->dir, "run directory")->required();
  options->until_option =
      app->add_option("--until", options->until_s, "stop after so many simulated seconds")->check(CLI::PositiveNumber);
  app->add_option("--threads", options->threads, "threads [the CPUs allowed]")->check(CLI::Range(1, 1024));
  app->footer("Example: plumbline replay runs/quickstart-1 --until 12.5\nExit code 1 when a digest differs");
  return {app, [options, table] { return replay(*options, table); }};
}

}  // namespace plumbline::scenarios
