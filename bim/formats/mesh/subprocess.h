// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace plumbline::bim {

/// Bounds of a task run apart.
struct IsolationConfig {
  unsigned cpu_s = 8;                                ///< CPU time; a hang ends here
  std::uint64_t memory = std::uint64_t{768} << 20U;  ///< bytes it may take beyond what the program holds already
  std::size_t answer = std::size_t{256} << 20U;      ///< longest answer, bytes
};

/// Bounds for reading so many bytes: what a sound file needs grows with its size.
[[nodiscard]] IsolationConfig isolation_for(std::size_t bytes, const IsolationConfig& least = {});

/// Runs `task` in a child process and returns what it returned: none when it crashed, hung, ran out of memory or
/// threw. For libraries that do not survive bad input. Throws EnvironmentError when no process can be made.
[[nodiscard]] std::optional<std::string> run_isolated(const std::function<std::string()>& task,
                                                      const IsolationConfig& config = {});

}  // namespace plumbline::bim
