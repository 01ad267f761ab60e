// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scenarios/app/command_line.h"

namespace plumbline::scenarios {

/// A page for man, in the macros of man(7).
struct ManualPage {
  std::string file;  ///< "plumbline-run.1"
  std::string text;
};

/// One page for the program, one for each of its commands; what stands below a command is a section of its page.
/// `help`: of the program, first, and of every command, each after the one above it. `version`: "plumbline 0.1.0".
[[nodiscard]] std::vector<ManualPage> manual_pages(const std::vector<CommandHelp>& help, const std::string& version);

}  // namespace plumbline::scenarios
