// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/interrupt.h"

#include <unistd.h>

#include <csignal>

namespace plumbline::scenarios {

namespace {

/// A signal handler can reach nothing but a variable of this kind.
volatile std::sig_atomic_t pending_signal = 0;

void note_signal(int signal) {
  if (pending_signal != 0) _exit(128 + signal);
  pending_signal = signal;
}

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = note_signal;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

void check_interrupt() {
  if (pending_signal != 0) throw Interrupted(pending_signal);
}

}  // namespace plumbline::scenarios
