// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/config/tree.h"

namespace plumbline::scenarios {

/// A scenario's tree whose `methods` are names alone: those given as maps stand under `processes`.
[[nodiscard]] Tree with_processes_apart(Tree scenario);
/// Gives each process that says none the folder.
[[nodiscard]] Tree with_process_folders(Tree scenario, const std::string& folder);

}  // namespace plumbline::scenarios
