// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scenarios/app/command_line.h"

namespace plumbline::scenarios {

/// Names that may stand where the help says METHOD or SCENARIO.
struct KnownNames {
  std::vector<std::string> methods;
  std::vector<std::string> scenarios;
};

/// A script for bash that completes commands, options and values of the program whose help this is; of its first entry,
/// which names the program. After METHOD a list with commas goes on.
[[nodiscard]] std::string bash_completion(const std::vector<CommandHelp>& help, const KnownNames& names);

/// The same for zsh, with the first sentence of each option's help.
[[nodiscard]] std::string zsh_completion(const std::vector<CommandHelp>& help, const KnownNames& names);

}  // namespace plumbline::scenarios
