// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace plumbline::slam {

/// What a process is started with, in a session of its own. Its standard input is empty.
struct SpawnPlan {
  std::vector<std::string> command;      ///< the program, found in PATH where it has no slash, and its arguments
  std::string folder;                    ///< its working directory; empty: ours
  std::vector<std::string> environment;  ///< NAME=VALUE, all of them
  int output = -1;                       ///< descriptor that it gets as standard output and error
  int stream = -1;                       ///< as descriptor 3
  int file = -1;                         ///< as descriptor 4; -1: none
};

/// Starts it. It is killed when the thread that called this ends, so that it does not outlive a killed program. Throws
/// ProcessFailure where it cannot be started, EnvironmentError where the system gives no process.
[[nodiscard]] pid_t spawn(const SpawnPlan& plan);

}  // namespace plumbline::slam
