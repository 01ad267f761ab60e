// SPDX-License-Identifier: Apache-2.0
#include "slam/io/ros2/bag_files.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <tuple>

#include "bim/config/file_ending.h"

namespace plumbline::slam {

namespace fs = std::filesystem;

namespace {

struct Part {
  std::string name;
  std::string bag;                      ///< with the ending, without the number
  std::optional<std::uint32_t> number;  ///< walk_7.db3 is part 7
};

Part part_of(const std::string& name) {
  const std::size_t dot = name.rfind('.'), line = name.rfind('_', dot);
  Part part{name, name, {}};
  std::uint32_t number = 0;
  if (line == std::string::npos || line + 1 == dot) return part;
  const auto [end, error] = std::from_chars(name.data() + line + 1, name.data() + dot, number);
  if (error != std::errc() || end != name.data() + dot) return part;
  part.bag = name.substr(0, line) + name.substr(dot);
  part.number = number;
  return part;
}

}  // namespace

BagFiles find_bag_files(const std::string& folder) {
  BagFiles files;
  std::error_code error;
  for (const char* says : {"/metadata.yaml", "/recording.yaml"})
    if (fs::exists(folder + says, error)) return files;
  std::vector<Part> parts;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if ((has_ending(name, ".db3") || has_ending(name, ".mcap")) && it->is_regular_file(error))
      parts.push_back(part_of(name));
  }
  std::sort(parts.begin(), parts.end(),
            [](const Part& a, const Part& b) { return std::tie(a.number, a.name) < std::tie(b.number, b.name); });
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const Part &first = parts.front(), &other = parts[i];
    if (first.number && other.number && other.bag == first.bag) continue;
    files.several = "'" + first.name.substr(0, 80) + "' and '" + other.name.substr(0, 80) + "'";
    return files;
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (files.missing.empty() && parts[i].number.value_or(0) > i)
      files.missing = parts[i].bag.substr(0, parts[i].bag.rfind('.')) + "_" + std::to_string(i) +
                      parts[i].bag.substr(parts[i].bag.rfind('.'));
    files.names.push_back(parts[i].name);
  }
  return files;
}

}  // namespace plumbline::slam
