// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace plumbline {

/// Bytes of the UTF-8 character at the start of `text` [yergeau2003], which is not empty; 0 where there is none.
[[nodiscard]] std::size_t utf8_length(std::string_view text);

/// Adds a character; U+FFFD for what is none (surrogates, above U+10FFFF).
void append_utf8(std::string& text, char32_t c);

/// Text of unknown encoding as UTF-8: UTF-8 stays, every other byte above 0x7F is the Latin-1 character it stands for.
[[nodiscard]] std::string utf8_of_bytes(std::string_view bytes);

/// Without the mark which some editors write before the first character of UTF-8.
[[nodiscard]] std::string_view without_byte_order_mark(std::string_view text);

}  // namespace plumbline
