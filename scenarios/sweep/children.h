// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace plumbline::scenarios {

/// How a child ended: its exit code, or 128 + the signal, and the last line it wrote to stderr.
struct ChildEnd {
  int code = 0;
  std::string last_line;
};

/// Whether the system failed a child, as a full disk does: exit code 3 without an internal error of the program.
[[nodiscard]] bool is_of_environment(const ChildEnd& end);
/// Whether the program itself broke: an internal error, or a signal that it brings on itself. Signals that others send,
/// as where memory runs out, are none.
[[nodiscard]] bool broke(const ChildEnd& end);

/// The last line of a child without the place in a file of `folder` at its begin, which the user did not write.
[[nodiscard]] std::string without_place(const std::string& last_line, const std::string& folder);

/// What run_children() starts where no other program is named.
inline constexpr const char* this_program = "/proc/self/exe";

/// Runs this program, or another one, `count` times, at most `jobs` at a time: `arguments(i)` are those of child i, and
/// `ended(i, end)` is called on this thread for each that ended, in no order. What they write to stderr is kept in
/// memory, so that a full disk has no say in it. No child outlives this process. Throws what `ended` throws,
/// Interrupted and EnvironmentError, after all children have been stopped. Call while the process has one thread.
void run_children(std::size_t count, int jobs, const std::function<std::vector<std::string>(std::size_t)>& arguments,
                  const std::function<void(std::size_t, const ChildEnd&)>& ended,
                  const std::string& program = this_program);

}  // namespace plumbline::scenarios
