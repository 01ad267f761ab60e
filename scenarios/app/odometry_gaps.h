// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "slam/io/recordings/sensor_frame.h"

namespace plumbline::scenarios {

/// Scans of a recording at which its odometry is old.
class OdometryGaps {
 public:
  void add(const slam::SensorFrame& frame);
  /// A sentence for the user; nothing where there was odometry all the time.
  [[nodiscard]] std::optional<std::string> warning() const;

 private:
  std::optional<slam::Nanoseconds> newest_;  ///< record
  std::optional<slam::Nanoseconds> first_;   ///< scan without
  int scans_ = 0, without_ = 0;
  bool ended_ = false;  ///< the last scan is without
};

}  // namespace plumbline::scenarios
