// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bim/config/printable.h"
#include "bim/errors.h"
#include "scenarios/app/commands.h"
#include "scenarios/app/estimate_score.h"
#include "scenarios/app/summary.h"
#include "scenarios/host/files.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/host/manifest.h"
#include "scenarios/host/progress.h"
#include "scenarios/host/terminal.h"
#include "scenarios/report/estimate/estimate_page.h"
#include "scenarios/report/estimate/page_file.h"
#include "scenarios/report/replay/replay_page.h"
#include "scenarios/report/report_builder.h"
#include "scenarios/run/ground_truth_recorder.h"
#include "scenarios/run/run_files.h"
#include "scenarios/run/runner.h"

namespace plumbline::scenarios {

namespace {

struct ReportArguments {
  std::string dir;
  bool replay = false;
  bool unchecked = false;
  double megabytes = 15.0;
};

/// The scans of a run, simulated again: they are the same, to the last bit, or nothing is shown.
ScanPacker simulate_scans(const std::string& dir, const FinishedRun& run) {
  const ResolvedScenario resolved = resolve(dir + "/scenario.yaml", {});
  ScanPacker scans = packer_of(resolved);
  Progress progress("scans", {resolved.scenario.duration_s, "s", true});
  RunOptions options;
  options.methods = false;
  options.tick = [&](double t_s) { progress.at(t_s); };
  options.observe = [&](const sim::WorldFrame& frame) { scans.add(frame.sensors.scan); };
  const RunRecord again = execute(resolved, options);
  if (sensor_digest_of(again.digests) != sensor_digest_of(run.record.digests))
    throw InputError({dir, 0, 0},
                     "simulated again, this run's scans come out otherwise: another version of the program made it");
  return scans;
}

/// The page of an estimate again.
int report_estimate(const ReportArguments& options) {
  if (options.replay)
    throw InputError({"--3d", 0, 0}, "is of run directories, whose scans can be simulated again; '" + options.dir +
                                         "' is an estimate of a recording");
  remove_abandoned(options.dir);
  const std::string page(estimate_page_name);
  const std::vector<std::string> altered = altered_files(options.dir, {{page}, false, DirectoryKind::estimate});
  refuse_altered(options.dir, altered, options.unchecked);
  std::string text = estimate_page(options.dir, altered);
  catch_interrupts();  // which nothing looks at: page and manifest appear together
  replace_files(options.dir, {{page, std::move(text)}});
  print("report: " + printable(options.dir) + "/" + page + "\n");
  return 0;
}

int report(const ReportArguments& options) {
  if (is_estimate_directory(options.dir)) return report_estimate(options);
  FinishedRun run = read_run(options.dir);
  remove_abandoned(options.dir);
  const std::vector<std::string> written_here = {"report.html", "replay.html"};
  run.altered = altered_files(options.dir, {written_here, false});
  refuse_altered(options.dir, run.altered, options.unchecked);
  const score::RunScore score = score::score_run(run);
  std::string written = "report: " + printable(options.dir) + "/report.html\n";
  catch_interrupts();  // looked at after the scans; page and manifest appear together
  if (options.replay) {
    const ScanPacker scans = simulate_scans(options.dir, run);
    check_interrupt();
    ReplayOptions most;
    most.most_bytes = static_cast<std::size_t>(options.megabytes * 1e6);
    write_file(options.dir + "/replay.html", render_replay(run, score, scans, read_graphs(options.dir, run), most));
    written += "replay: " + printable(options.dir) + "/replay.html\n";
  }
  ReportInput input = report_input(run, score);
  input.has_replay = options.replay || std::filesystem::exists(options.dir + "/replay.html");
  write_file(options.dir + "/report.html", render_report(input));
  renew_manifest(options.dir, written_here);
  print(written);
  return 0;
}

}  // namespace

Command add_report(CommandLine& program) {
  const auto options = std::make_shared<ReportArguments>();
  CommandLine line = program.add_command(
      "report", "Writes report.html of a run or an estimate again, and replay.html of a run if asked");
  line.option("DIR", options->dir, "run directory, or directory that plumbline estimate wrote").takes("DIR").required();
  line.flag(
      "--3d", options->replay,
      "of a run: also write replay.html, the run in three dimensions at any of its times; simulates its scans again");
  line.option("--size-mb", options->megabytes,
              "maximum size of replay.html; scans far from failures and events are left out until it fits [15]")
      .range(1.0, 1000.0);
  line.flag("--unchecked", options->unchecked, "takes files that were altered since they were written");
  line.footer(
      "Example: plumbline report --3d runs/quickstart-1\n"
      "         plumbline report estimates/street");
  return {line, [options] { return report(*options); }};
}

}  // namespace plumbline::scenarios
