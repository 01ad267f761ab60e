// SPDX-License-Identifier: Apache-2.0
#include "scenarios/host/interrupt.h"

#include <unistd.h>

#include <csignal>
#include <string_view>

#include "slam/io/stopwatch.h"

namespace plumbline::scenarios {

namespace {

/// A signal handler can reach nothing but variables of this kind.
volatile std::sig_atomic_t pending_signal = 0;
volatile std::sig_atomic_t pending_since_s = 0;

/// Some programs send a signal to the process and to its group: the second, at once, is the same request.
void note_signal(int signal) {
  constexpr std::sig_atomic_t patience_s = 2;
  const auto now_s = static_cast<std::sig_atomic_t>(slam::wall_s());
  if (pending_signal != 0) {
    if (now_s - pending_since_s >= patience_s) _exit(128 + signal);
    return;
  }
  pending_since_s = now_s;
  pending_signal = signal;
}

/// Nothing here may allocate or lock.
void end_process(int signal) {
  constexpr std::string_view message = "plumbline: interrupted; nothing was written\n";
  static_cast<void>(!::write(STDERR_FILENO, message.data(), message.size()));
  _exit(128 + signal);
}

void handle_signals(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction hangup {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // nohup asked for it to be ignored
}

}  // namespace

void catch_interrupts() { handle_signals(note_signal); }

void exit_on_interrupts() { handle_signals(end_process); }

void check_interrupt() {
  if (pending_signal != 0) throw Interrupted(pending_signal);
}

}  // namespace plumbline::scenarios
