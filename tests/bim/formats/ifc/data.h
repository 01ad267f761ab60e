// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace plumbline::bim {

/// Path of a test data file, whether or not it is there.
inline std::string data_path(const std::string& name) {
  const char* data = std::getenv("PLUMBLINE_DATA");
  const char* source = std::getenv("PLUMBLINE_SOURCE");
  const std::filesystem::path root =
      data != nullptr ? std::filesystem::path(data)
                      : std::filesystem::path(source != nullptr ? source : ".") / ".." / "shared" / "data";
  return (root / name).string();
}

}  // namespace plumbline::bim
