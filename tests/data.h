// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace plumbline {

/// Path of a file of the project, from its root.
inline std::string project_file(const std::string& name) {
  const char* const source = std::getenv("PLUMBLINE_SOURCE");
  return (std::filesystem::path(source != nullptr ? source : ".") / name).string();
}

/// Path of a test file: the project's own in tests/data, else that of others in the folder that PLUMBLINE_DATA names,
/// whether or not it is there.
inline std::string data_path(const std::string& name) {
  const std::string own = project_file("tests/data/" + name);
  const char* const data = std::getenv("PLUMBLINE_DATA");
  return data == nullptr || std::filesystem::exists(own) ? own : (std::filesystem::path(data) / name).string();
}

/// Why a test that needs this file cannot run: the reason to skip it. Empty when the file is there.
inline std::string data_missing(const std::string& name) {
  return std::filesystem::exists(data_path(name)) ? "" : name + " is missing; PLUMBLINE_DATA names its folder";
}

}  // namespace plumbline
