// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace plumbline {

/// Text of an input as one line that a terminal shows and does not obey. Control characters (C0, delete, C1), line
/// and paragraph separators, and characters that turn the direction of writing are written as "\u001b", as JSON does;
/// bytes that are no UTF-8 likewise, as the Latin-1 characters that they stand for.
[[nodiscard]] std::string printable(std::string_view text);

/// The same of several lines: line breaks stay.
[[nodiscard]] std::string printable_lines(std::string_view text);

}  // namespace plumbline
