// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_string.h"

#include <optional>

#include "bim/config/tree.h"
#include "bim/config/utf8.h"

namespace plumbline::bim {
namespace {

/// The code point that begins at `at`, which moves past it.
char32_t next_code_point(std::string_view text, std::size_t& at) {
  const std::size_t length = utf8_length(text.substr(at));
  const auto lead = static_cast<unsigned char>(text[at]);
  if (length <= 1) {
    ++at;
    return length == 1 ? lead : 0xFFFD;
  }
  char32_t c = lead & (0xFFU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) c = (c << 6U) | (static_cast<unsigned char>(text[at + i]) & 0x3FU);
  at += length;
  return c;
}

void put_hex(std::string& text, char32_t c, unsigned digits) {
  for (unsigned i = digits; i-- > 0;) text += "0123456789ABCDEF"[(c >> (4U * i)) & 15U];
}

std::optional<char32_t> hex(std::string_view digits) {
  char32_t value = 0;
  for (const char c : digits) {
    const bool number = c >= '0' && c <= '9';
    if (!number && (c < 'A' || c > 'F')) return std::nullopt;
    value = value * 16 + static_cast<char32_t>(number ? c - '0' : c - 'A' + 10);
  }
  return value;
}

/// Decodes "\X2\....\X0\" or "\X4\........\X0\" at `at`; false and nothing done where it is malformed.
bool take_group(std::string_view text, std::size_t& at, std::string& result) {
  constexpr std::string_view closing = "\\X0\\";
  if (text.size() < at + 4 || text[at + 3] != '\\') return false;
  const std::size_t digits = text[at + 2] == '2' ? 4 : 8;
  const std::size_t begin = at + 4, end = text.find(closing, begin);
  if (end == std::string_view::npos || (end - begin) % digits != 0) return false;
  std::string decoded;
  for (std::size_t i = begin; i < end; i += digits) {
    std::optional<char32_t> c = hex(text.substr(i, digits));
    if (!c) return false;
    // Two surrogates in a row are one character beyond the basic plane, as some programs write it.
    if (digits == 4 && *c >= 0xD800 && *c < 0xDC00 && i + 8 <= end) {
      const std::optional<char32_t> low = hex(text.substr(i + 4, 4));
      if (low && *low >= 0xDC00 && *low < 0xE000) {
        c = 0x10000U + ((*c - 0xD800U) << 10U) + (*low - 0xDC00U);
        i += 4;
      }
    }
    append_utf8(decoded, *c);
  }
  result += decoded;
  at = end + closing.size();
  return true;
}

/// Decodes the escape at `at`; false where there is none.
bool take_escape(std::string_view text, std::size_t& at, std::string& result) {
  const std::string_view rest = text.substr(at);
  if (rest.starts_with("\\\\")) {
    result += '\\';
    at += 2;
    return true;
  }
  if (rest.starts_with("\\X2\\") || rest.starts_with("\\X4\\")) return take_group(text, at, result);
  if (rest.starts_with("\\X\\") && rest.size() >= 5) {
    const std::optional<char32_t> c = hex(rest.substr(3, 2));
    if (!c) return false;
    append_utf8(result, *c);
    at += 5;
    return true;
  }
  if (rest.starts_with("\\S\\") && rest.size() >= 4) {
    append_utf8(result, static_cast<unsigned char>(rest[3]) + 0x80U);
    at += 4;
    return true;
  }
  return false;
}

}  // namespace

std::string step_string(std::string_view utf8) {
  std::string result = "'";
  char group = 0;  // '2' or '4' while one is open
  for (std::size_t at = 0; at < utf8.size();) {
    const char32_t c = next_code_point(utf8, at);
    const char wanted = c >= 0x20 && c < 0x7F ? '\0' : c < 0x10000 ? '2' : '4';
    if (wanted != group) {
      if (group != 0) result += "\\X0\\";
      if (wanted != 0) result += wanted == '2' ? "\\X2\\" : "\\X4\\";
      group = wanted;
    }
    if (wanted != 0) {
      put_hex(result, c, wanted == '2' ? 4 : 8);
      continue;
    }
    result += static_cast<char>(c);
    if (c == '\'' || c == '\\') result += static_cast<char>(c);
  }
  if (group != 0) result += "\\X0\\";
  result += '\'';
  return result;
}

std::string text_of_step(std::string_view quoted) {
  std::string result;
  for (std::size_t at = 0; at < quoted.size();) {
    if (quoted[at] == '\\' && take_escape(quoted, at, result)) continue;
    result += quoted[at];
    at += quoted.substr(at).starts_with("''") ? 2 : 1;
  }
  return utf8_of_bytes(result);
}

std::string step_real(double value) {
  std::string text = format_number(value);
  const std::size_t exponent = text.find('e');
  const std::size_t mantissa_end = exponent == std::string::npos ? text.size() : exponent;
  if (exponent != std::string::npos) text[exponent] = 'E';
  if (text.find('.') == std::string::npos) text.insert(mantissa_end, 1, '.');
  return text;
}

}  // namespace plumbline::bim
