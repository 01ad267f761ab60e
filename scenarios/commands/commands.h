// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "slam/methods.h"

namespace CLI {
class App;
}

namespace plumbline::scenarios {

/// A subcommand adds itself to the program and returns what to do when it is asked for: its exit code.
/// `table`: the methods to choose from; must outlive the action.
using Action = std::function<int()>;
struct Command {
  CLI::App* app = nullptr;
  Action action;
};

[[nodiscard]] Command add_run(CLI::App& program, slam::MethodTable table);
[[nodiscard]] Command add_inspect(CLI::App& program);
[[nodiscard]] Command add_generate(CLI::App& program);
[[nodiscard]] Command add_score(CLI::App& program);
[[nodiscard]] Command add_report(CLI::App& program);
[[nodiscard]] Command add_replay(CLI::App& program, slam::MethodTable table);
[[nodiscard]] Command add_diff(CLI::App& program);
[[nodiscard]] Command add_methods(CLI::App& program, slam::MethodTable table);
[[nodiscard]] Command add_scenarios(CLI::App& program);
[[nodiscard]] Command add_simulate(CLI::App& program, slam::MethodTable table);
[[nodiscard]] Command add_estimate(CLI::App& program, slam::MethodTable table);
[[nodiscard]] Command add_bench(CLI::App& program);

}  // namespace plumbline::scenarios
