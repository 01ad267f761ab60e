// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <string>
#include <vector>

namespace plumbline::slam {

inline void write_raw(const std::string& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

inline void write_floats(const std::string& file, const std::vector<float>& values) {
  write_raw(file, {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)});
}

}  // namespace plumbline::slam
