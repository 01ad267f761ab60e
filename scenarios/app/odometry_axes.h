// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slam/io/recordings/sensor_frame.h"

namespace plumbline::scenarios {

/// Signs that odometry is in other axes than its frames say (z up, x ahead, y to the left) or in other units, or has
/// stopped.
class OdometryAxes {
 public:
  void add(const slam::SensorFrame& frame);
  /// Sentences for the user.
  [[nodiscard]] std::vector<std::string> warnings() const;

 private:
  [[nodiscard]] double gyro_turn_of(const slam::SensorFrame& frame);
  void add_speed_and_standstill(const slam::Odometry& newest, double gyro_turn);

  std::optional<slam::Nanoseconds> first_stamp_;
  std::optional<double> start_tilt_deg_;
  std::optional<slam::Odometry> last_;
  std::optional<slam::Nanoseconds> last_imu_;
  std::vector<double> speeds_mps_;           ///< between scans, while it moves
  double still_s_ = 0.0, still_turn_ = 0.0;  ///< since it changed last, and what the gyro turned in it ...
  double longest_still_s_ = 0.0, longest_still_end_s_ = 0.0;  ///< ... and of the longest that the gyro turned in
  double turned_ = 0.0;                                       ///< rad, both ways
  double product_ = 0.0, odometry_squares_ = 0.0, gyro_squares_ = 0.0;  ///< of the turns between scans
};

}  // namespace plumbline::scenarios
