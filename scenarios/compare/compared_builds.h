// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

namespace plumbline::scenarios {

/// Two builds of the program and the sweep that both are to run.
struct ComparedBuilds {
  std::string a, b;  ///< programs, by their paths
  std::string sweep;
  std::string out;
  int seeds = 0;  ///< 0: those of the sweep
  int jobs = 1;
};

/// A file that may be executed.
[[nodiscard]] bool is_program(const std::string& path);

/// Runs the sweep with one program after the other, as its children, into OUT/a and OUT/b, and gives these folders.
/// Runs that are there stay, as of any sweep, if they are of the same programs: OUT/programs.json has their digests.
/// Throws InputError where a program refuses its input or OUT is of other programs, EnvironmentError and Interrupted.
[[nodiscard]] std::pair<std::string, std::string> sweep_with_both(const ComparedBuilds& builds);

}  // namespace plumbline::scenarios
