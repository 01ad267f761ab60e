// SPDX-License-Identifier: Apache-2.0
#include "bim/ifc/step_parse.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wconversion"
#include <ifcpp/model/BuildingModel.h>
#include <ifcpp/reader/ReaderSTEP.h>
#pragma GCC diagnostic pop

#include <cstdint>

#include "bim/errors.h"

namespace plumbline::bim {

std::string schema_for_reader(const std::string& schema) {
  if (schema == "IFC2X3" || schema == "IFC4") return schema;
  return schema.starts_with("IFC2X") ? "IFC2X3" : "IFC4";
}

std::shared_ptr<BuildingModel> parse_step(const std::string& text, const std::string& schema, const std::string& file) {
  // loadModelFromFile() wants the locale en_US and gives an empty model without it; this does not.
  auto model = std::make_shared<BuildingModel>();
  try {
    ReaderSTEP reader;
    std::string content = text;
    // It reads files of no other schema than these two, and knows them by this name.
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
  std::string result;
  const auto put = [&](std::uint32_t byte) { result += static_cast<char>(static_cast<unsigned char>(byte)); };
  for (const wchar_t wide : text) {
    const auto c = static_cast<std::uint32_t>(wide);
    if (c < 0x80) {
      put(c);
    } else if (c < 0x800) {
      put(0xC0 | (c >> 6U));
      put(0x80 | (c & 0x3FU));
    } else if (c < 0x10000) {
      put(0xE0 | (c >> 12U));
      put(0x80 | ((c >> 6U) & 0x3FU));
      put(0x80 | (c & 0x3FU));
    } else {
      put(0xF0 | ((c >> 18U) & 0x07U));
      put(0x80 | ((c >> 12U) & 0x3FU));
      put(0x80 | ((c >> 6U) & 0x3FU));
      put(0x80 | (c & 0x3FU));
    }
  }
  return result;
}

}  // namespace plumbline::bim
