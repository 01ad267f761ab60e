// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/program.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>
#include <system_error>
#include <utility>

#include "bim/errors.h"
#include "scenarios/app/commands.h"
#include "scenarios/app/process.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/host/terminal.h"
#include "scenarios/run/method_runner.h"
#include "scenarios/spec/method_names.h"

namespace plumbline::scenarios {

namespace {

enum ExitCode { bad_input = 2, environment_or_internal = 3, scenario_failed = 4 };

int print_error(const std::string& text, int code) {
  print_note(text);
  return code;
}

/// Of stdout: as `head` goes once it has seen enough.
bool reader_gone() {
  pollfd out{STDOUT_FILENO, POLLOUT, 0};
  return ::poll(&out, 1, 0) > 0 && (out.revents & POLLERR) != 0;
}

/// One line on stderr and the exit code for whatever is being thrown.
int report_failure() {
  try {
    throw;
  } catch (const InputError& error) {
    return print_error(error.what(), bad_input);
  } catch (const ScenarioFailure& error) {
    return print_error(error.what(), scenario_failed);
  } catch (const Interrupted& error) {
    return print_error(std::string("plumbline: ") + error.what(), 128 + error.signal());
  } catch (const EnvironmentError& error) {
    return print_error(error.what(), environment_or_internal);
  } catch (const std::system_error& error) {  // no thread, no room on a disk
    return print_error(std::string("plumbline: ") + error.what(), environment_or_internal);
  } catch (const std::exception& error) {
    return print_error(std::string("plumbline: internal error: ") + error.what(), environment_or_internal);
  }
}

/// The table of methods: ours, then the program's own. Throws InternalError where two have one name.
std::vector<slam::MethodRow> with_ours(std::vector<slam::MethodRow> own_methods) {
  std::vector<slam::MethodRow> table(slam::methods().begin(), slam::methods().end());
  for (slam::MethodRow& row : own_methods) {
    if (row.name == truth_method || slam::find_method(row.name, table) != nullptr)
      throw InternalError("method '" + std::string(row.name) + "' is in the table already; give it another name");
    if (row.name.ends_with(lidar_ending))
      throw InternalError("method '" + std::string(row.name) +
                          "' ends as those with LiDAR alone; give it another name");
    table.push_back(std::move(row));
  }
  return table;
}

CommandLine program_line() {
  CommandLine program(
      "Walks a legged robot with an emulated spinning LiDAR (VLP-16 by default) through a building model and scores "
      "SLAM and localization methods against ground truth.",
      "plumbline");
  program.version(std::string("plumbline ") + PLUMBLINE_VERSION);
  program.needs_command();
  program.footer(
      "Example: plumbline run scenarios/library/quickstart.yaml --out runs/first\n"
      "Exit codes: 0 success, 1 a gate failed, a method crashed or a comparison differs, 2 bad usage or input, "
      "3 environment or internal error, 4 the robot fell or stalled, 130/143 interrupted");
  return program;
}

/// Adds every command, in the order of the help.
std::vector<Command> add_commands(CommandLine& program, slam::MethodTable table) {
  return {add_run(program, table),
          add_inspect(program),
          add_generate(program),
          add_score(program),
          add_report(program),
          add_replay(program, table),
          add_diff(program),
          add_compare(program),
          add_shrink(program),
          add_hunt(program, table),
          add_methods(program, table),
          add_scenarios(program),
          add_bench(program),
          add_simulate(program, table),
          add_estimate(program, table),
          add_identify(program),
          add_sweep(program, table),
          add_conformance(program),
          add_doctor(program),
          add_completion(program, table),
          add_manual(program)};
}

int parse_and_run(int argc, char** argv, slam::MethodTable table) {
  CommandLine program = program_line();
  const std::vector<Command> commands = add_commands(program, table);
  if (!program.parse({argv + std::min(argc, 1), argv + argc})) return 0;
  for (const Command& command : commands)
    if (command.line.asked()) return command.action();
  return bad_input;
}

}  // namespace

std::vector<CommandHelp> program_help() {
  CommandLine program = program_line();
  const std::vector<Command> commands = add_commands(program, slam::methods());  // they hold what the options write to
  return program.help();
}

int run_program(int argc, char** argv, std::vector<slam::MethodRow> own_methods) {
  settle_process();
  reexecute_with_tunables(argv);
  try {
    const std::vector<slam::MethodRow> table = with_ours(std::move(own_methods));
    const int code = parse_and_run(argc, argv, table);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
      if (reader_gone()) return 128 + SIGPIPE;
      throw EnvironmentError("plumbline: stdout cannot be written");
    }
    return code;
  } catch (...) {
    return report_failure();
  }
}

}  // namespace plumbline::scenarios
