// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "slam/io/recordings/sensor_frame.h"

namespace plumbline::scenarios {

/// Whether odometry has another clock than the IMU: the lag at which its turns correlate best with the gyro's.
class OdometryClock {
 public:
  void add(const slam::SensorFrame& frame);
  /// By how much later odometry is stamped, s; nothing where both turn too little, or alike at no lag of up to a
  /// second.
  [[nodiscard]] std::optional<double> lag_s() const;
  /// A sentence for the user; nothing where the lag is not known or small.
  [[nodiscard]] std::optional<std::string> warning() const;

 private:
  /// About R's z axis, rad, in steps of time from the first record on.
  struct Turns {
    std::vector<double> by_step;
    std::optional<slam::Nanoseconds> last;

    /// Spreads a turn evenly over the time since the record before.
    void add(slam::Nanoseconds first, slam::Nanoseconds stamp, double turn);
  };

  std::optional<slam::Nanoseconds> first_;
  std::optional<slam::Odometry> odometry_;
  Turns by_odometry_, by_gyro_;
};

}  // namespace plumbline::scenarios
