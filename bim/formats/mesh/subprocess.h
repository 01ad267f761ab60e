// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace plumbline::bim {

/// Limits of a task in a subprocess.
struct SubprocessLimits {
  unsigned cpu_s = 8;                                ///< CPU time, which bounds what a file can ask for
  double wall_s = 160.0;                             ///< time that passes: far more, for a task that has to wait
  std::uint64_t memory = std::uint64_t{768} << 20U;  ///< bytes beyond those the program holds already
  std::size_t answer = std::size_t{256} << 20U;      ///< longest answer, bytes
};

/// Limits for reading so many bytes: the need of a valid file grows with its size.
[[nodiscard]] SubprocessLimits subprocess_limits(std::size_t bytes, const SubprocessLimits& least = {});

/// How a task ended; `failed`: it crashed, ran out of memory, threw, or its answer was too long.
enum class SubprocessEnd { answered, failed, out_of_cpu_time, out_of_wall_time };

/// What a task in a subprocess came to.
struct SubprocessResult {
  SubprocessEnd end = SubprocessEnd::failed;
  std::optional<std::string> answer;  ///< there where it answered
};

/// Runs `task` in a child process and returns what it returned. For libraries that do not survive bad input. Throws
/// EnvironmentError when no process can be made.
[[nodiscard]] SubprocessResult run_in_subprocess(const std::function<std::string()>& task,
                                                 const SubprocessLimits& config = {});

}  // namespace plumbline::bim
