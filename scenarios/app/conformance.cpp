// SPDX-License-Identifier: Apache-2.0
#include "slam/process/conformance.h"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bim/config/printable.h"
#include "bim/errors.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "scenarios/app/commands.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/host/terminal.h"
#include "scenarios/spec/process_spec.h"
#include "slam/process/trial_walk.h"

namespace plumbline::scenarios {

namespace {

struct ConformanceArguments {
  std::vector<std::string> command;
  bool plan = false;
  bool quiet = false;
  double start_s = 30.0;
  double scan_s = 10.0;
};

/// Words as they came, or one text that is split as --method splits it.
std::vector<std::string> words_of(const std::vector<std::string>& words) {
  std::string text = words.front();
  if (text.starts_with("NAME=")) text.erase(0, 5);
  const bool file = std::filesystem::exists(text);
  return words.size() == 1 && !file ? process_of("mine=" + text, "", "COMMAND")->command : words;
}

int check(const ConformanceArguments& options, const std::vector<std::string>& rest) {
  if (rest.empty())
    throw InputError({"COMMAND", 0, 0},
                     "is missing; say what starts your method, as in conformance python3 my_slam.py");
  if (rest.front().starts_with('-'))
    throw InputError({"plumbline", 0, 0}, "unknown option '" + rest.front() + "'; see plumbline conformance --help");
  slam::ProcessCommand command;
  command.name = "mine";
  command.command = words_of(rest);
  check_program(command.command, std::filesystem::current_path().string(), {"COMMAND", 0, 0});
  command.needs_plan = options.plan;
  command.start_s = options.start_s;
  command.scan_s = options.scan_s;
  if (!options.quiet) command.printed = [](std::string_view text) { std::fwrite(text.data(), 1, text.size(), stderr); };
  std::shared_ptr<const bim::Plan> plan;
  if (options.plan)
    plan =
        std::make_shared<const bim::Plan>(bim::make_plan(bim::read_plan_text(slam::trial_plan(), "trial.plan.yaml")));
  int wrong = 0;
  catch_interrupts();
  const auto say = [&](const slam::Finding& finding) {
    const bool bad = finding.kind == slam::Finding::Kind::wrong;
    const char* word = bad ? "WRONG " : finding.kind == slam::Finding::Kind::note ? "note  " : "ok    ";
    print(word + printable(finding.text) + "\n");
    std::fflush(stdout);
    wrong += bad ? 1 : 0;
  };
  slam::check_conformance(command, plan, say, check_interrupt);
  print(wrong == 0 ? "conforms\n" : "does not conform\n");
  return wrong == 0 ? 0 : 1;
}

}  // namespace

Command add_conformance(CommandLine& program) {
  const auto options = std::make_shared<ConformanceArguments>();
  CommandLine line = program.add_command(
      "conformance", "Tries a method that is a process on a small walk, and says what is wrong with it");
  line.takes_rest("COMMAND [ARGUMENT...]");
  line.flag("--plan", options->plan, "it localizes: it gets the plan of the walk, and answers in its frame");
  line.flag("--quiet", options->quiet, "what it prints is not passed on to stderr");
  line.option("--start-s", options->start_s, "most time to start, s [30]").range(0.01, 86400.0);
  line.option("--scan-s", options->scan_s, "most time for the answer to one scan, s [10]").range(0.01, 86400.0);
  line.footer(
      "Example: plumbline conformance python3 my_slam.py\n"
      "         plumbline conformance --plan ./my_localization --config my.yaml\n"
      "Exit codes: 0 it conforms, 1 it does not");
  return {line, [options, line] { return check(*options, line.rest()); }};
}

}  // namespace plumbline::scenarios
