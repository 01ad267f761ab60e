// SPDX-License-Identifier: Apache-2.0
#include "scenarios/hunt/hunt.h"

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
#include "scenarios/host/files.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/host/progress.h"
#include "scenarios/host/terminal.h"
#include "scenarios/hunt/hunt_schema.h"
#include "scenarios/hunt/hunt_text.h"
#include "scenarios/shrink/trial.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

namespace {

struct HuntArguments {
  std::string file;
  std::string out;
  int jobs = 0;
  int max_runs = 0;
  int shrink = 0;
  int shrink_runs = 200;
  std::string fail_on = "fault";
  bool schema = false;
  bool force = false;
};

HuntResult hunt_with_progress(const Hunt& hunt, const std::string& work, int jobs, slam::MethodTable table) {
  Progress progress(hunt.file.name, {static_cast<double>(hunt.file.runs), "runs"});
  return run_hunt(hunt, {work, jobs, [&](int runs) { progress.at(runs); }, {}}, table);
}

void write_findings(const std::string& staging, const HuntResult& result) {
  for (std::size_t i = 0; i < result.findings.size(); ++i) {
    const std::string folder = staging + "/" + folder_of_finding(i);
    fs::create_directories(folder);
    write_case(folder, case_of(result, result.findings[i]));
  }
}

/// A crash of the whole program leaves no run to shrink.
bool leaves_run(const HuntFinding& finding) { return !finding.failure.error.starts_with("the program died"); }

/// Runs a finding and shrinks that run, in processes of their own.
void shrink_finding(const std::string& folder, const HuntFinding& finding, const HuntArguments& options) {
  constexpr int gate_failed = 1;
  run_program_once({"run", folder + "/scenario.yaml", "--out", folder + "/run"}, {0, gate_failed});
  std::vector<std::string> words = {"shrink",     folder + "/run",
                                    "--method",   finding.failure.method,
                                    "--out",      folder + "/small",
                                    "--jobs",     std::to_string(options.jobs),
                                    "--max-runs", std::to_string(options.shrink_runs)};
  if (finding.failure.gate) words.insert(words.end(), {"--gate", finding.failure.gate->metric});
  run_program_once(words, {0});
}

void write_tables(const std::string& staging, const Hunt& hunt, const HuntResult& result) {
  write_file(staging + "/hunt.csv", hunt_csv(hunt, result));
  write_file(staging + "/hunt.json", write_json(hunt_results(hunt, result)) + "\n");
}

void note_unshrunk(const std::string& folder, const std::string& why) {
  print_note("plumbline: warning: " + printable(folder) + " is not shrunk: " + printable(why));
}

/// The first findings. What was found stays when this is interrupted, or when one of them cannot be shrunk.
void shrink_findings(const std::string& staging, HuntResult& result, const HuntArguments& options) {
  const auto count = std::min(result.findings.size(), static_cast<std::size_t>(options.shrink));
  Progress progress("shrink", {static_cast<double>(count), "findings"});
  for (std::size_t i = 0; i < count; ++i) {
    if (!leaves_run(result.findings[i])) continue;
    const std::string folder = staging + "/" + folder_of_finding(i);
    try {
      shrink_finding(folder, result.findings[i], options);
    } catch (const Interrupted& interrupted) {
      for (const char* unfinished : {"/run", "/small"}) fs::remove_all(folder + unfinished);
      result.signal = interrupted.signal();
      return;
    } catch (const EnvironmentError& error) {
      note_unshrunk(folder_of_finding(i), error.what());
    } catch (const InputError& error) {
      note_unshrunk(folder_of_finding(i), error.what());
    }
    progress.at(static_cast<double>(i + 1));
  }
}

int hunt(HuntArguments options, slam::MethodTable table) {
  if (options.schema) {
    std::fputs(hunt_page().c_str(), stdout);
    return 0;
  }
  if (options.file.empty()) throw InputError({"HUNT", 0, 0}, "is required: a hunt file; see plumbline hunt --help");
  if (options.out.empty()) throw InputError({"--out", 0, 0}, "is required: a folder for what is found");
  if (options.jobs == 0) options.jobs = allowed_cpus();
  Hunt hunt = read_hunt(options.file);
  if (options.max_runs > 0) hunt.file.runs = options.max_runs;
  catch_interrupts();
  RunDirectory directory(options.out, DirectoryKind::hunt, options.force);
  const std::string work = directory.staging() + "/work";
  fs::create_directory(work);
  HuntResult result = hunt_with_progress(hunt, work, options.jobs, table);
  std::error_code error;
  fs::remove_all(work, error);
  if (result.runs.empty()) throw Interrupted(result.signal);
  write_findings(directory.staging(), result);
  write_tables(directory.staging(), hunt, result);
  if (result.signal == 0 && options.shrink > 0) {
    shrink_findings(directory.staging(), result, options);
    if (result.signal != 0) write_tables(directory.staging(), hunt, result);  // they say that it was interrupted
  }
  directory.commit();
  if (result.signal != 0)
    throw Interrupted(result.signal, options.out + " holds the first " + std::to_string(result.runs.size()) + " runs");
  print(hunt_text(hunt, result, options.out) + "table: " + printable(options.out) + "/hunt.csv\n");
  constexpr int scenario_failed = 4;
  if (!any_walked(result)) return scenario_failed;
  return !result.findings.empty() && options.fail_on == "fault" ? 1 : 0;
}

}  // namespace

Command add_hunt(CommandLine& program, slam::MethodTable table) {
  const auto options = std::make_shared<HuntArguments>();
  CommandLine line = program.add_command("hunt", "Searches for failures that are a method's fault");
  line.option("HUNT", options->file, "hunt file (.yaml)");
  line.option("-o,--out", options->out, "folder for what is found, new or empty").takes("DIR");
  line.option("--max-runs", options->max_runs, "number of runs, in place of the file's").range(1, 100000);
  line.option("--jobs", options->jobs, "runs at a time; no result depends on it [the CPUs allowed]").range(1, 1024);
  const Argument shrink =
      line.option("--shrink", options->shrink, "also runs the worst of the first N kinds and shrinks it")
          .range(1, 1000);
  line.option("--shrink-runs", options->shrink_runs, "with --shrink: greatest number of runs to shrink each with")
      .range(1, 1'000'000)
      .needs(shrink)
      .shows_default();
  line.option("--fail-on", options->fail_on,
              "what makes the exit code 1: fault, a failure that is a method's; or never")
      .one_of({"fault", "never"})
      .shows_default();
  line.flag("--schema", options->schema, "prints instead every key of hunt files, with examples");
  line.flag("--force", options->force, "replace what an earlier hunt left in --out");
  line.footer(
      "Example: plumbline hunt slippery.yaml -o hunts/slippery\n"
      "         plumbline hunt corridors.yaml --max-runs 40 --shrink 2 -o hunts/corridors\n"
      "Exit code 1 when a failure that is a method's fault was found, 4 when no walk came to its end");
  return {line, [options, table] { return hunt(*options, table); }};
}

}  // namespace plumbline::scenarios
