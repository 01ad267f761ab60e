// SPDX-License-Identifier: Apache-2.0
#include "scenarios/host/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "bim/config/printable.h"
#include "slam/io/stopwatch.h"

namespace plumbline::scenarios {

namespace {

constexpr double redrawn_s = 0.2;  // on a terminal
constexpr double line_s = 60.0;    // elsewhere
constexpr double settled_s = 1.0;  // before, a rate says little

/// "0:51", "12:03", "1:02:03"
std::string clock_text(double seconds) {
  const auto s = static_cast<long>(std::lround(seconds));
  char text[32];
  if (s >= 3600)
    std::snprintf(text, sizeof(text), "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
  else
    std::snprintf(text, sizeof(text), "%ld:%02ld", s / 60, s % 60);
  return text;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), value < 9.95 && value != std::round(value) ? "%.1f" : "%.0f", value);
  return text;
}

}  // namespace

std::string progress_text(double done, const ProgressOf& of, double wall_s, bool bar) {
  constexpr int width = 20;
  std::string text;
  if (bar && of.all > 0.0) {
    const int full = static_cast<int>(width * std::clamp(done / of.all, 0.0, 1.0));
    text = "[" + std::string(static_cast<std::size_t>(full), '#') +
           std::string(static_cast<std::size_t>(width - full), '.') + "] ";
  }
  const std::string at_most = of.at_most ? "at most " : "";
  text += number(std::floor(done));
  if (of.all > 0.0) text += " of " + at_most + number(of.all);
  text += " " + of.unit;
  if (wall_s < settled_s || done <= 0.0) return text;
  const double rate = done / wall_s;
  text += of.unit == "s" ? ", " + number(rate) + " times as fast as real"
                         : ", " + (rate >= 1.0 ? number(rate) + " a second" : number(60.0 * rate) + " a minute");
  if (of.all > 0.0) text += ", " + at_most + clock_text(std::max(0.0, of.all - done) / rate) + " left";
  return text;
}

Progress::Progress(const std::string& what, ProgressOf of)
    : what_(printable(what)),
      of_(std::move(of)),
      start_(slam::wall_s()),
      last_shown_(start_),
      terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (terminal_) std::fputs("\r\033[K", stderr);
}

void Progress::at(double done) {
  const double now = slam::wall_s();
  if (now - last_shown_ < (terminal_ ? redrawn_s : line_s)) return;
  last_shown_ = now;
  show(progress_text(done, of_, now - start_, terminal_));
}

void Progress::phase(const std::string& text) {
  if (terminal_) show(text);
}

void Progress::show(const std::string& text) {
  std::fprintf(stderr, terminal_ ? "\r\033[K%s: %s" : "%s: %s\n", what_.c_str(), text.c_str());
  std::fflush(stderr);
}

}  // namespace plumbline::scenarios
