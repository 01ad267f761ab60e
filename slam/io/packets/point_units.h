// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "slam/io/packets/point_cloud.h"

namespace plumbline::slam {

/// What a topic's scans tell of the unit of their coordinates.
class PointUnits {
 public:
  void add(const CloudScan& scan) {
    ++scans_;
    in_mm_ += scan.in_mm ? 1 : 0;
    far_ += scan.far ? 1 : 0;
  }
  /// What was assumed, or does not fit, a sentence each.
  [[nodiscard]] std::vector<std::string> said() const {
    std::vector<std::string> all;
    if (in_mm_ > 0) all.emplace_back("the points' coordinates are whole numbers, which are taken as millimetres");
    if (2 * far_ > scans_)
      all.emplace_back(
          "most points are farther than 500 m; coordinates are to be in metres: divide them by 1000 where they are "
          "millimetres");
    return all;
  }

 private:
  std::int64_t scans_ = 0, in_mm_ = 0, far_ = 0;
};

}  // namespace plumbline::slam
