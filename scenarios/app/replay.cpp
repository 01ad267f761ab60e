// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "bim/config/printable.h"
#include "bim/errors.h"
#include "scenarios/app/commands.h"
#include "scenarios/app/process.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/host/manifest.h"
#include "scenarios/host/progress.h"
#include "scenarios/host/terminal.h"
#include "scenarios/run/run_files.h"
#include "scenarios/run/runner.h"
#include "slam/io/recordings/tum.h"

namespace plumbline::scenarios {

namespace {

struct ReplayArguments {
  std::string dir;
  double until_s = 0.0;
  int threads = 0;
  bool unchecked = false;
  std::optional<Argument> until_option;
};

/// Leaves out what comes after `until`, and the answers at the end of a run, which a shorter one gives earlier.
DigestLog cut(DigestLog log, const std::optional<double>& until_s) {
  if (!until_s) return log;
  const auto last = static_cast<slam::Nanoseconds>(std::llround(*until_s * 1e9));
  std::erase_if(log, [&](const DigestEntry& entry) { return entry.tick > last || entry.stage.ends_with("/estimate"); });
  return log;
}

/// The first trajectory on disk that is not what the run gives again; empty where all are.
std::string other_file(const std::string& dir, const RunRecord& again) {
  const auto differs = [&](const std::string& name, const std::vector<slam::StampedPose>& poses) {
    const std::string path = dir + "/" + name, text = slam::write_tum(poses);
    return !std::filesystem::exists(path) ||
           (std::filesystem::file_size(path) > 0 ? read_text_file(path) : std::string()) != text;
  };
  if (differs("truth.tum", again.truth_W)) return "truth.tum";
  for (const MethodRecord& method : again.methods) {
    if (is_oracle(method)) continue;
    if (differs(method.name + ".tum", method.causal)) return method.name + ".tum";
    if (differs(method.name + ".final.tum", method.estimate.trajectory)) return method.name + ".final.tum";
  }
  return {};
}

int replay(const ReplayArguments& options, slam::MethodTable table) {
  check_run_directory(options.dir);
  refuse_altered(options.dir, altered_files(options.dir, {}), options.unchecked);
  const std::string path = options.dir + "/digests.csv";
  const DigestLog recorded = read_digests(read_text_file(path), path);
  const std::optional<double> until_s = options.until_option->given() ? std::optional(options.until_s) : std::nullopt;
  const DigestLog expected = cut(recorded, until_s);
  if (expected.empty())
    throw InputError({path, 0, 0}, "holds no digest" + (until_s && !recorded.empty()
                                                            ? " up to then; the first is at " +
                                                                  slam::format_stamp(recorded.front().tick) + " s"
                                                            : std::string()));
  const ResolvedScenario resolved = resolve(options.dir + "/scenario.yaml", {}, table);
  RunOptions run_options;
  run_options.threads = options.threads > 0 ? options.threads : allowed_cpus();
  run_options.until_s = until_s;

  catch_interrupts();
  RunRecord record;
  {
    Progress progress("replay", {run_options.until_s.value_or(resolved.scenario.duration_s), "s", true});
    run_options.tick = [&](double t) { progress.at(t); };
    record = execute(resolved, run_options);
  }
  const DigestLog again = cut(record.digests, until_s);
  const auto difference = first_difference(expected, again);
  if (!difference) {
    const std::string other = until_s ? std::string() : other_file(options.dir, record);
    if (!other.empty()) {
      print("equal digests, but " + printable(other) + " is not what the run gives\n");
      return 1;
    }
    std::printf("equal: %zu digests\n", again.size());
    return 0;
  }
  print("first difference at " + slam::format_stamp(difference->tick) + " s in " + printable(difference->stage) + ": " +
        difference->what + " (the first is the recorded run)\n");
  return 1;
}

}  // namespace

Command add_replay(CommandLine& program, slam::MethodTable table) {
  const auto options = std::make_shared<ReplayArguments>();
  CommandLine line = program.add_command("replay", "Runs a run directory again and compares every digest");
  line.option("DIR", options->dir, "run directory").takes("DIR").required();
  options->until_option = line.option("--until", options->until_s, "stop after so many simulated seconds").positive();
  line.option("--threads", options->threads, "threads [the CPUs allowed]").range(1, 1024);
  line.flag("--unchecked", options->unchecked, "runs although files were altered since they were written");
  line.footer(
      "Example: plumbline replay runs/quickstart-1 --until 12.5\nExit code 1 when a digest or a trajectory differs");
  return {line, [options, table] { return replay(*options, table); }};
}

}  // namespace plumbline::scenarios
