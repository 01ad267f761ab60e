// SPDX-License-Identifier: Apache-2.0
#include "scenarios/host/terminal.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "bim/config/printable.h"

namespace plumbline::scenarios {

void print(std::string_view lines) {
  const std::string text = printable_lines(lines);
  std::fwrite(text.data(), 1, text.size(), stdout);
}

void print_data(std::string_view text) {
  if (::isatty(STDOUT_FILENO) == 1) return print(text);
  std::fwrite(text.data(), 1, text.size(), stdout);
}

void print_note(const std::string& line) {
  std::string text = line;
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::fprintf(stderr, "%s\n", printable(text).c_str());
}

std::string shell_argument(const std::string& text) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_-./=+,:@%").find(c) != std::string_view::npos;
  };
  if (!text.empty() && std::all_of(text.begin(), text.end(), plain)) return text;
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace plumbline::scenarios
