// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace plumbline::slam {

/// The only clocks of the program. Their readings go to timings.json and the terminal, never into a result.
[[nodiscard]] double thread_cpu_s();   ///< CPU time of this thread, s
[[nodiscard]] double process_cpu_s();  ///< CPU time of all threads, s
[[nodiscard]] double wall_s();         ///< since some fixed moment, s
/// CPU time of another process, s; 0 where the system does not tell.
[[nodiscard]] double process_cpu_s(int pid);

/// CPU time of this thread since it was made or last restarted.
class Stopwatch {
 public:
  Stopwatch() : start_(thread_cpu_s()) {}
  [[nodiscard]] double cpu_ms() const { return 1e3 * (thread_cpu_s() - start_); }
  void restart() { start_ = thread_cpu_s(); }

 private:
  double start_;
};

}  // namespace plumbline::slam
