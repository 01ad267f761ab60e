// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bim/config/tree.h"
#include "slam/io/recordings/recording.h"

namespace plumbline::scenarios {

/// The scans that a method got.
struct ScansRead {
  std::int64_t count = 0;
  std::int64_t empty = 0;  ///< scans without a return
  int rings = 0;           ///< the most, of scans with returns
  bool timed = false;      ///< returns have times of their own

  void add(const slam::Scan& scan);
};

/// What was read, in one line.
[[nodiscard]] std::string words_of(const slam::Taken& taken, const ScansRead& scans, bool has_odometry);
/// The same as a part of estimate.yaml.
[[nodiscard]] Tree to_tree(const slam::Taken& taken, const ScansRead& scans);
/// What of a recording that was read a user should know.
[[nodiscard]] std::vector<std::string> warnings_of(const slam::Recording& recording);

}  // namespace plumbline::scenarios
