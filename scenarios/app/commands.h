// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "scenarios/app/command_line.h"
#include "slam/methods.h"

namespace plumbline::scenarios {

/// A subcommand adds itself to the program and returns what to do when it is asked for: its exit code.
/// `table`: the methods to choose from; must outlive the action.
using Action = std::function<int()>;
struct Command {
  CommandLine line;
  Action action;
};

[[nodiscard]] Command add_run(CommandLine& program, slam::MethodTable table);
[[nodiscard]] Command add_inspect(CommandLine& program);
[[nodiscard]] Command add_sweep(CommandLine& program, slam::MethodTable table);
[[nodiscard]] Command add_identify(CommandLine& program);
[[nodiscard]] Command add_generate(CommandLine& program);
[[nodiscard]] Command add_score(CommandLine& program);
[[nodiscard]] Command add_report(CommandLine& program);
[[nodiscard]] Command add_replay(CommandLine& program, slam::MethodTable table);
[[nodiscard]] Command add_diff(CommandLine& program);
[[nodiscard]] Command add_compare(CommandLine& program);
[[nodiscard]] Command add_shrink(CommandLine& program);
[[nodiscard]] Command add_hunt(CommandLine& program, slam::MethodTable table);
[[nodiscard]] Command add_methods(CommandLine& program, slam::MethodTable table);
[[nodiscard]] Command add_scenarios(CommandLine& program);
[[nodiscard]] Command add_simulate(CommandLine& program, slam::MethodTable table);
[[nodiscard]] Command add_estimate(CommandLine& program, slam::MethodTable table);
[[nodiscard]] Command add_conformance(CommandLine& program);
[[nodiscard]] Command add_doctor(CommandLine& program);
[[nodiscard]] Command add_completion(CommandLine& program, slam::MethodTable table);
[[nodiscard]] Command add_manual(CommandLine& program);
[[nodiscard]] Command add_bench(CommandLine& program);

}  // namespace plumbline::scenarios
