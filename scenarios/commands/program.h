// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace plumbline::scenarios {

/// The whole program: settles the process (see process.h), reads the command line, runs the subcommand, turns
/// exceptions into one line on stderr. Returns the exit code of the contract.
int run_program(int argc, char** argv);

}  // namespace plumbline::scenarios
