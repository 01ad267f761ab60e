// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_parse.h"

#include <ifcpp/model/BuildingModel.h>
#include <ifcpp/reader/ReaderSTEP.h>

#include <charconv>
#include <cstdint>
#include <string_view>
#include <system_error>
#include <utility>

#include "bim/config/utf8.h"
#include "bim/errors.h"

namespace plumbline::bim {
namespace {

constexpr std::string_view long_code = "\\X4\\", code_end = "\\X0\\";

/// "\X4\" and eight digits a character as "\X2\" with pairs of surrogates, and how long the former is; 0 where it is
/// cut off or no character.
std::pair<std::string, std::size_t> as_surrogates(std::string_view rest) {
  constexpr std::size_t each = 8, most = 1000;  // characters
  const std::size_t end = rest.substr(0, each * (most + 1)).find(code_end);
  if (end == std::string_view::npos || end == long_code.size() || (end - long_code.size()) % each != 0) return {};
  std::string units = "\\X2\\";
  const auto append = [&](std::uint32_t unit) {
    for (const unsigned shift : {12U, 8U, 4U, 0U}) units += "0123456789ABCDEF"[(unit >> shift) & 15U];
  };
  for (std::size_t at = long_code.size(); at < end; at += each) {
    std::uint32_t code = 0;
    const char* last = rest.data() + at + each;
    const auto [stop, error] = std::from_chars(rest.data() + at, last, code, 16);
    if (error != std::errc() || stop != last || code > 0x10FFFF) return {};
    if (code >= 0x10000) append(0xD800U + ((code - 0x10000U) >> 10U));
    append(code >= 0x10000 ? 0xDC00U + ((code - 0x10000U) & 0x3FFU) : code);
  }
  return {units + std::string(code_end), end + code_end.size()};
}

/// "\X\hh" for the escape "\S\c" or "\\" at the beginning of `rest`, and how long that is; 0 for all else, such as the
/// single backslashes of a path.
std::pair<std::string, std::size_t> as_code(std::string_view rest) {
  if (rest.starts_with("\\\\")) return {"\\X\\5C", 2};
  if (rest.starts_with(long_code))
    if (auto pair = as_surrogates(rest); pair.second > 0) return pair;
  if (rest.size() >= 4 && (rest[1] == 'X' || rest[1] == 'P') && rest[3] == '\\')
    return {std::string(rest.substr(0, 4)), 4};
  if (rest.starts_with("\\X\\")) return {std::string(rest.substr(0, 3)), 3};
  if (rest.starts_with("\\'")) return {"\\X\\5C", 1};  // the end of a path, not a quote
  if (!rest.starts_with("\\S\\") || rest.size() < 4) return {};
  const char c = rest[3];
  const bool quote = c == '\'';
  if (c < ' ' || c > '~' || (quote && !rest.substr(3).starts_with("''"))) return {};
  const unsigned code = static_cast<unsigned char>(c) + 0x80U;
  const auto digit = [](unsigned v) { return "0123456789ABCDEF"[v & 15U]; };
  return {std::string("\\X\\") + digit(code >> 4U) + digit(code), quote ? 5 : 4};
}

/// IFC++ takes what looks like the beginning of a comment for one in strings, too, keeps quotes and backslashes
/// doubled, and does not decode "\S\c" before another backslash, nor "\X4\": there these are written as their codes.
std::string with_plain_strings(std::string_view text) {
  constexpr std::string_view comment = "/*", star = "/\\X\\2A", quotes = "''", quote = "\\X\\27";
  std::string result;
  bool in_string = false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const std::string_view rest = text.substr(at);
    if (in_string && (rest.starts_with(comment) || rest.starts_with(quotes))) {
      result += rest.starts_with(comment) ? star : quote;
      ++at;
      continue;
    }
    if (in_string && text[at] == '\\') {
      if (const auto [code, length] = as_code(rest); length > 0) {
        result += code;
        at += length - 1;
        continue;
      }
    }
    if (text[at] == '\'') in_string = !in_string;
    result += text[at];
  }
  return result;
}

}  // namespace

std::string schema_for_reader(const std::string& schema) {
  if (schema == "IFC2X3" || schema == "IFC4") return schema;
  return schema.starts_with("IFC2X") ? "IFC2X3" : "IFC4";
}

std::shared_ptr<BuildingModel> parse_step(const std::string& text, const std::string& schema, const std::string& file) {
  // loadModelFromFile() needs the locale en_US and gives an empty model without it; this does not.
  auto model = std::make_shared<BuildingModel>();
  try {
    ReaderSTEP reader;
    std::string content = with_plain_strings(text);
    // It reads files of no other schema than these two, and identifies them by this name.
    // It reads the line of FILE_SCHEMA only, in which the schema need not stand.
    const std::size_t begin = content.find("FILE_SCHEMA");
    const std::size_t end = begin == std::string::npos ? begin : content.find(';', begin);
    if (end != std::string::npos)
      content.replace(begin, end - begin, "FILE_SCHEMA(('" + schema_for_reader(schema) + "'))");
    reader.loadModelFromString(content, model);
  } catch (const std::exception& error) {
    throw InputError({file, 0, 0}, std::string("the file cannot be read as IFC: ") + error.what());
  }
  return model;
}

std::string utf8(const std::wstring& text) {
  // IFC++ widens bytes of unescaped text as signed numbers, and leaves pairs of surrogates as they are.
  const auto code = [&](std::size_t i) { return i < text.size() ? static_cast<std::uint32_t>(text[i]) : 0U; };
  constexpr std::uint32_t least_byte = 0xFFFFFF80;
  std::string result, bytes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::uint32_t c = code(i), next = code(i + 1);
    if (c >= least_byte) bytes += static_cast<char>(static_cast<unsigned char>(c));
    if (next < least_byte) {
      result += utf8_of_bytes(bytes);
      bytes.clear();
    }
    if (c >= least_byte) continue;
    const bool pair = c >= 0xD800 && c < 0xDC00 && next >= 0xDC00 && next < 0xE000;
    append_utf8(result, pair ? 0x10000U + ((c - 0xD800U) << 10U) + (next - 0xDC00U) : c);
    i += pair ? 1 : 0;
  }
  return result;
}

}  // namespace plumbline::bim
