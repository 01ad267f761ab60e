// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace plumbline::scenarios {

/// The user asked the program to stop: exit code 128 + signal.
class Interrupted : public std::runtime_error {
 public:
  explicit Interrupted(int signal) : std::runtime_error("interrupted"), signal_(signal) {}
  [[nodiscard]] int signal() const { return signal_; }

 private:
  int signal_;
};

/// From here on SIGINT and SIGTERM only leave a note, which check_interrupt() finds; a second one ends the process.
void catch_interrupts();
/// Throws Interrupted when a signal came.
void check_interrupt();

}  // namespace plumbline::scenarios
