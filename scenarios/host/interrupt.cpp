// SPDX-License-Identifier: Apache-2.0
#include "scenarios/host/interrupt.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <string_view>

#include "slam/io/stopwatch.h"

namespace plumbline::scenarios {

namespace {

/// A signal handler can reach nothing but variables of this kind.
volatile std::sig_atomic_t pending_signal = 0;
volatile std::sig_atomic_t pending_since_s = 0;
volatile std::sig_atomic_t wake_descriptor = -1;

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
  const int failure = errno;
  const std::uint64_t one = 1;
  static_cast<void>(!::write(wake_descriptor, &one, sizeof one));
  errno = failure;
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

void catch_interrupts() {
  if (wake_descriptor < 0) wake_descriptor = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  handle_signals(note_signal);
}

void exit_on_interrupts() { handle_signals(end_process); }

void check_interrupt() {
  if (pending_signal != 0) throw Interrupted(pending_signal);
}

int interrupt_descriptor() { return wake_descriptor; }

}  // namespace plumbline::scenarios
