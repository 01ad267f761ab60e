// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "bim/config/tree.h"

namespace plumbline::scenarios {

/// A scenario's tree whose `methods` are names alone: those given as maps stand under `processes`.
[[nodiscard]] Tree with_processes_apart(Tree scenario);
/// Where a process starts that says `own`, which may be relative to the folder, or nothing.
[[nodiscard]] std::string process_folder(const std::optional<std::string>& own, const std::string& folder);
/// Gives each process the folder in which it starts; one that it says is relative to `folder`.
[[nodiscard]] Tree with_process_folders(Tree scenario, const std::string& folder);

}  // namespace plumbline::scenarios
