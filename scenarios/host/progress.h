// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace plumbline::scenarios {

/// What is counted on the way, and whether `all` may come out smaller.
struct ProgressOf {
  double all = 0.0;        ///< 0: not known
  std::string unit = "s";  ///< of what is done: "s" is simulated or recorded time
  bool at_most = false;    ///< `all` is a bound: a walk may end before
};

/// "[#########...........] 54 of at most 240 s, 3.6 times as fast as real, at most 0:51 left"; `wall_s`: since the
/// begin.
[[nodiscard]] std::string progress_text(double done, const ProgressOf& of, double wall_s, bool bar);

/// How far something is, on stderr: on a terminal one line that is drawn again, elsewhere a line a minute.
class Progress {
 public:
  Progress(const std::string& what, ProgressOf of);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void at(double done);
  /// Names what is being done, without a number.
  void phase(const std::string& text);

 private:
  void show(const std::string& text);

  std::string what_;
  ProgressOf of_;
  double start_;
  double last_shown_;
  bool terminal_;
};

}  // namespace plumbline::scenarios
