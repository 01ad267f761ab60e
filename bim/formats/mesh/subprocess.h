// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace plumbline::bim {

/// Limits of a task in a subprocess.
struct SubprocessLimits {
  unsigned cpu_s = 8;                                ///< CPU time
  unsigned wall_s = 24;                              ///< time that passes, also while the task waits
  std::uint64_t memory = std::uint64_t{768} << 20U;  ///< bytes beyond those the program holds already
  std::size_t answer = std::size_t{256} << 20U;      ///< longest answer, bytes
};

/// Limits for reading so many bytes: the need of a valid file grows with its size.
[[nodiscard]] SubprocessLimits subprocess_limits(std::size_t bytes, const SubprocessLimits& least = {});

/// Runs `task` in a child process and returns what it returned: none when it crashed, hung, ran out of memory or
/// threw. For libraries that do not survive bad input. Throws EnvironmentError when no process can be made.
[[nodiscard]] std::optional<std::string> run_in_subprocess(const std::function<std::string()>& task,
                                                           const SubprocessLimits& config = {});

}  // namespace plumbline::bim
