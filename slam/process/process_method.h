// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "slam/io/method.h"

namespace plumbline::slam {

/// A method that is a program of the user's.
struct ProcessCommand {
  std::string name;
  std::vector<std::string> command;  ///< the program and its arguments; found in PATH where it has no slash
  std::string folder;                ///< it starts there; empty: where this program was started
  bool needs_plan = false;
  bool repeat = false;  ///< a second process gets the same, and must answer the same
  double start_s = 30.0;
  double scan_s = 10.0;
  double finish_s = 120.0;
  /// As conformance is: it must end with 0 within 5 s of its last answer, send nothing reserved and nothing after it,
  /// and print or log at most 16 MiB for one answer.
  bool strict = false;
  std::function<void(std::string_view)> printed = {};  ///< gets what it prints, as it comes
  /// Gets each answer, to a scan or at the end, byte for byte; of `repeat`, those of the first process.
  std::function<void(std::span<const std::byte>)> answered = {};
  std::function<void()> go_on = {};  ///< called while it is waited for; what it throws ends that, and the process
};

/// Runs the program and speaks with it in lock step, slam/process/client/plumbline_messages.h: a scan and what was
/// measured since the one before, then its answer. It gets what a method gets, and no clock but its own. Throws
/// ProcessFailure, also from the method's functions, where the program cannot be started, ends, hangs, or answers what
/// it must not.
[[nodiscard]] std::unique_ptr<Method> make_process_method(const ProcessCommand& command, const MethodInput& input);

}  // namespace plumbline::slam
