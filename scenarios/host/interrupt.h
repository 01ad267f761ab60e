// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace plumbline::scenarios {

/// The user asked the program to stop: exit code 128 + signal.
class Interrupted : public std::runtime_error {
 public:
  explicit Interrupted(int signal, const std::string& left = "nothing was written")
      : std::runtime_error("interrupted; " + left), signal_(signal) {}
  [[nodiscard]] int signal() const { return signal_; }

 private:
  int signal_;
};

/// From here on SIGINT, SIGTERM and SIGHUP only leave a note, which check_interrupt() finds; one that comes 2 s or more
/// after it ends the process.
void catch_interrupts();
/// From here on, until catch_interrupts(), SIGINT, SIGTERM and SIGHUP end the process at once with the message and exit
/// code of Interrupted: for work that has written nothing.
void exit_on_interrupts();
/// Throws Interrupted when a signal came.
void check_interrupt();
/// For poll(): readable once check_interrupt() throws, in whatever thread the signal came, so that none is missed
/// between a check and a wait. Negative before catch_interrupts(), and where the process has no descriptor left.
[[nodiscard]] int interrupt_descriptor();

}  // namespace plumbline::scenarios
