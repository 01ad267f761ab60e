// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bim/config/tree.h"
#include "scenarios/shrink/run_case.h"

namespace plumbline::scenarios {

/// What came of a run that was tried.
struct Trial {
  std::optional<Tree> results;  ///< its results.json; nothing where it left none
  int signal = 0;               ///< that ended the program, as of a memory error
  bool refused = false;         ///< before its walk: an input error
  std::string why;              ///< in words, where it left no results or its walk failed
};

/// Runs all of these cases; `ended` is called as each ends, where it is not empty.
using TryCases =
    std::function<std::vector<Trial>(const std::vector<RunCase>& cases, const std::function<void()>& ended)>;

/// Runs each case in a child process of its own, at most `jobs` at a time, in folders of `folder`, which go again; what
/// comes of them does not depend on `jobs`. `ended` is called as each ends. Throws Interrupted and EnvironmentError,
/// also where a child says that its environment failed.
[[nodiscard]] std::vector<Trial> try_cases(const std::vector<RunCase>& cases, const std::string& folder, int jobs,
                                           const std::function<void()>& ended = {});

/// try_cases() in this folder with so many jobs.
[[nodiscard]] TryCases in_processes(const std::string& folder, int jobs);

/// Runs this program once with these arguments. Throws EnvironmentError where it ends with a code other than those of
/// `allowed`.
void run_program_once(const std::vector<std::string>& arguments, const std::vector<int>& allowed);

}  // namespace plumbline::scenarios
