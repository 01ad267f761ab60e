// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace plumbline::scenarios {

/// One line on stderr that says how far a run is; silent where stderr is no terminal.
class Progress {
 public:
  Progress(const std::string& what, double longest_s);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void at(double simulated_s);
  /// Names what is being done, without a number.
  void phase(const std::string& text);

 private:
  void show(const std::string& text);

  std::string what_;
  double longest_s_;
  double start_;
  double last_shown_ = -1.0;
  bool terminal_;
};

}  // namespace plumbline::scenarios
