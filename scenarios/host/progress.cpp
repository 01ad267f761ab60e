// SPDX-License-Identifier: Apache-2.0
#include "scenarios/host/progress.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "bim/config/printable.h"
#include "slam/io/stopwatch.h"

namespace plumbline::scenarios {

namespace {
constexpr double refresh_s = 0.2;
}

Progress::Progress(const std::string& what, double longest_s)
    : what_(printable(what)), longest_s_(longest_s), start_(slam::wall_s()), terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (terminal_) std::fputs("\r\033[K", stderr);
}

void Progress::at(double simulated_s) {
  if (!terminal_) return;
  const double now = slam::wall_s();
  if (now - last_shown_ < refresh_s) return;
  last_shown_ = now;
  char text[96];
  const double speed = simulated_s / std::max(now - start_, 1e-3);
  std::snprintf(text, sizeof(text), "%.0f s walked of at most %.0f s, %.1f times as fast as real", simulated_s,
                longest_s_, speed);
  show(text);
}

void Progress::phase(const std::string& text) {
  if (terminal_) show(text);
}

void Progress::show(const std::string& text) {
  std::fprintf(stderr, "\r\033[K%s: %s", what_.c_str(), text.c_str());
  std::fflush(stderr);
}

}  // namespace plumbline::scenarios
