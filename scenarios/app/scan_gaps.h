// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slam/io/records.h"

namespace plumbline::scenarios {

/// Times without scans in a recording, as where a driver stopped or a bag lost messages.
class ScanGaps {
 public:
  void add(slam::Nanoseconds stamp);
  /// A sentence for the user; nothing where scans came all the time.
  [[nodiscard]] std::optional<std::string> warning() const;

 private:
  std::vector<slam::Nanoseconds> stamps_;
};

}  // namespace plumbline::scenarios
