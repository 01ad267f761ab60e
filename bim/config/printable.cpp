// SPDX-License-Identifier: Apache-2.0
#include "bim/config/printable.h"

#include <array>

#include "bim/config/utf8.h"

namespace plumbline {

namespace {

struct Range {
  char32_t first, last;
};
/// C0, delete with C1, Arabic letter mark, marks of direction, separators with embeddings, isolates.
constexpr std::array<Range, 6> obeyed = {
    {{0x00, 0x1F}, {0x7F, 0x9F}, {0x061C, 0x061C}, {0x200E, 0x200F}, {0x2028, 0x202E}, {0x2066, 0x2069}}};

bool is_obeyed(char32_t c) {
  for (const Range& range : obeyed)
    if (c >= range.first && c <= range.last) return true;
  return false;
}

/// The character that these bytes of UTF-8 are.
char32_t decoded(std::string_view bytes) {
  const auto first = static_cast<unsigned char>(bytes.front());
  if (bytes.size() == 1) return first;
  char32_t c = first & (0x7FU >> bytes.size());
  for (const char byte : bytes.substr(1)) c = (c << 6U) | (static_cast<unsigned char>(byte) & 0x3FU);
  return c;
}

void append_escaped(std::string& text, char32_t c) {
  static constexpr std::string_view hex = "0123456789abcdef";
  text += "\\u";
  for (const int shift : {12, 8, 4, 0}) text += hex[(c >> shift) & 15U];
}

std::string escaped(std::string_view text, bool keep_breaks) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const std::string_view bytes = text.substr(0, length == 0 ? 1 : length);
    text.remove_prefix(bytes.size());
    const char32_t c = decoded(bytes);
    if (length == 0 || (is_obeyed(c) && !(keep_breaks && c == U'\n')))
      append_escaped(out, c);
    else
      out += bytes;
  }
  return out;
}

}  // namespace

std::string printable(std::string_view text) { return escaped(text, false); }

std::string printable_lines(std::string_view text) { return escaped(text, true); }

}  // namespace plumbline
