// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scenarios/app/command_line.h"
#include "slam/methods.h"

namespace plumbline::scenarios {

/// The whole program: prepares the process (see process.h), reads the command line, runs the subcommand, turns
/// exceptions into one line on stderr. Returns the exit code, docs/guide/exit_codes.md. `own_methods` are added to the
/// table of methods of every command, so that a main that passes a method of its own is a whole testbench for it.
int run_program(int argc, char** argv, std::vector<slam::MethodRow> own_methods = {});

/// What `plumbline --help` prints, and every command's --help.
[[nodiscard]] std::vector<CommandHelp> program_help();

}  // namespace plumbline::scenarios
