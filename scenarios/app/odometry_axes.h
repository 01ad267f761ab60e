// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slam/io/recordings/sensor_frame.h"

namespace plumbline::scenarios {

/// Signs that odometry is in other axes than its frames say: z up, x ahead, y to the left.
class OdometryAxes {
 public:
  void add(const slam::SensorFrame& frame);
  /// Sentences for the user.
  [[nodiscard]] std::vector<std::string> warnings() const;

 private:
  [[nodiscard]] double gyro_turn_of(const slam::SensorFrame& frame);

  std::optional<double> start_tilt_deg_;
  std::optional<slam::Odometry> last_;
  std::optional<slam::Nanoseconds> last_imu_;
  double turned_ = 0.0;                                                 ///< rad, both ways
  double product_ = 0.0, odometry_squares_ = 0.0, gyro_squares_ = 0.0;  ///< of the turns between scans
};

}  // namespace plumbline::scenarios
