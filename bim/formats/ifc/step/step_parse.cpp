// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_parse.h"

#include <ifcpp/model/BuildingModel.h>
#include <ifcpp/reader/ReaderSTEP.h>

#include <cstdint>
#include <string_view>

#include "bim/config/utf8.h"
#include "bim/errors.h"

namespace plumbline::bim {
namespace {

/// IFC++ takes what looks like the beginning of a comment for one in strings, too, and keeps a quote doubled: there the
/// star and the quote are written as their codes.
std::string with_plain_strings(std::string_view text) {
  constexpr std::string_view comment = "/*", star = "/\\X\\2A", quotes = "''", quote = "\\X\\27", shifted = "\\S\\";
  std::string result;
  bool in_string = false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const std::string_view rest = text.substr(at);
    if (in_string && (rest.starts_with(comment) || rest.starts_with(quotes))) {
      const bool escape = !result.ends_with(shifted);  // or what is behind it, one character
      result += rest.starts_with(comment) ? star : escape ? quote : quotes;
      ++at;
      continue;
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
    const std::size_t header = content.find("FILE_SCHEMA");
    const std::size_t begin = header == std::string::npos ? header : content.find('\'', header);
    const std::size_t end = begin == std::string::npos ? begin : content.find('\'', begin + 1);
    if (end != std::string::npos) content.replace(begin + 1, end - begin - 1, schema_for_reader(schema));
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
