// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace plumbline::scenarios {

/// Writes lines to stdout as bim/config/printable.h shows them: names of inputs cannot steer a terminal. A JSON text
/// stays the same value.
void print(std::string_view lines);

/// Writes a text that is to be read back byte for byte; on a terminal as print() does.
void print_data(std::string_view text);

/// A text as a shell takes it for one word.
[[nodiscard]] std::string shell_argument(const std::string& text);

/// Writes one line to stderr, whatever breaks of lines are in it.
void print_note(const std::string& line);

}  // namespace plumbline::scenarios
