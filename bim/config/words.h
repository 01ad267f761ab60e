// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

namespace plumbline {

/// The text without the spaces, tabs and carriage returns at its ends.
[[nodiscard]] std::string_view without_blanks(std::string_view text);
/// What stands between spaces, tabs and carriage returns.
[[nodiscard]] std::vector<std::string_view> split_words(std::string_view line);

}  // namespace plumbline
