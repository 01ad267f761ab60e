// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace plumbline::scenarios {

/// Where the scenarios that come with the program lie: installed beside it, or in the tree that it was built in. Empty
/// where they are in neither.
[[nodiscard]] std::string library_folder();

/// Files of scenarios in a folder and those in it, in order; also those of which nobody knows, as they are no YAML.
/// What is no file, as a link to nothing, is left out, and so is a folder that cannot be opened.
[[nodiscard]] std::vector<std::string> scenario_files(const std::string& folder);

/// What INPUT of a command names: itself where it is there; else the scenario of the library that has this name, with
/// or without the folders before it, as in "quickstart" or "s_graphs/t7". INPUT again where it says by an ending that
/// it is a file, and without a library. Throws InputError where several have the name, or none.
[[nodiscard]] std::string find_input(const std::string& input);

}  // namespace plumbline::scenarios
