// SPDX-License-Identifier: Apache-2.0
#include "bim/ifc/step_string.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "bim/config/tree.h"

namespace plumbline::bim {
namespace {

constexpr char32_t replacement = 0xFFFD;
constexpr char32_t largest = 0x10FFFF;

bool is_surrogate(char32_t c) { return c >= 0xD800 && c <= 0xDFFF; }

/// The code point that begins at `at`, which moves past it.
char32_t next_code_point(std::string_view text, std::size_t& at) {
  const auto lead = static_cast<unsigned char>(text[at++]);
  if (lead < 0x80) return lead;
  const int more = lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : 1;
  constexpr std::array<char32_t, 4> least{0, 0x80, 0x800, 0x10000};
  if (lead < 0xC2 || lead > 0xF4 || at + static_cast<std::size_t>(more) > text.size()) return replacement;
  char32_t c = lead & (0x3FU >> static_cast<unsigned>(more));
  for (int i = 0; i < more; ++i) {
    const auto byte = static_cast<unsigned char>(text[at + static_cast<std::size_t>(i)]);
    if ((byte & 0xC0U) != 0x80U) return replacement;
    c = (c << 6U) | (byte & 0x3FU);
  }
  if (c < least[static_cast<std::size_t>(more)] || c > largest || is_surrogate(c)) return replacement;
  at += static_cast<std::size_t>(more);
  return c;
}

void put_utf8(std::string& text, char32_t c) {
  if (c > largest || is_surrogate(c)) c = replacement;
  const auto put = [&](char32_t byte) { text += static_cast<char>(static_cast<unsigned char>(byte)); };
  if (c < 0x80) return put(c);
  if (c < 0x800) {
    put(0xC0U | (c >> 6U));
  } else if (c < 0x10000) {
    put(0xE0U | (c >> 12U));
    put(0x80U | ((c >> 6U) & 0x3FU));
  } else {
    put(0xF0U | (c >> 18U));
    put(0x80U | ((c >> 12U) & 0x3FU));
    put(0x80U | ((c >> 6U) & 0x3FU));
  }
  put(0x80U | (c & 0x3FU));
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
    put_utf8(decoded, *c);
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
    put_utf8(result, *c);
    at += 5;
    return true;
  }
  if (rest.starts_with("\\S\\") && rest.size() >= 4) {
    put_utf8(result, static_cast<unsigned char>(rest[3]) + 0x80U);
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
  return result;
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
