// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "slam/io/records.h"

namespace plumbline::slam {

enum class LidarModelId { vlp16, vlp32c, hdl32e, os1_64 };
[[nodiscard]] constexpr std::array<std::string_view, 4> names_of(LidarModelId) {
  return {"vlp16", "vlp32c", "hdl32e", "os1_64"};
}

/// Which echoes of a beam a sensor reports.
enum class ReturnMode { strongest, last, dual };
[[nodiscard]] constexpr std::array<std::string_view, 3> names_of(ReturnMode) { return {"strongest", "last", "dual"}; }

/// One laser of a spinning LiDAR.
struct Laser {
  double elevation_deg = 0.0;
  double cosine = 1.0;  ///< of the elevation
  double sine = 0.0;
  double azimuth_deg = 0.0;  ///< added to the head's azimuth, clockwise seen from above
  double height_m = 0.0;     ///< of its origin above the sensor's
  std::int32_t time_ns = 0;  ///< of its shot after the start of a firing
  int ring = 0;              ///< rank by elevation, 0 the lowest
};

/// A spinning LiDAR: all that distinguishes one model from another.
struct LidarModel {
  std::string_view name;
  std::uint8_t product = 0;  ///< factory byte of Velodyne's packets, 0: sends none
  double range_unit_m = 0.002;
  double range_min_m = 0.4;
  double range_max_m = 100.0;
  Nanoseconds firing_period_ns = 0;  ///< from a laser's shot to its next
  int firings_per_packet = 0;        ///< with one return a beam; half as many with two
  double packet_rate_hz = 0.0;       ///< with one return, as the ROS driver rounds it
  std::span<const Laser> lasers;     ///< by channel, in firing order

  [[nodiscard]] int rings() const { return static_cast<int>(lasers.size()); }
};

[[nodiscard]] const LidarModel& lidar_model(LidarModelId id);
/// The model of this product byte, or nullptr.
[[nodiscard]] const LidarModel* velodyne_model(int product);

/// Firings of one message, a little more than one turn: as many packets as the ROS driver waits for at this speed.
/// Throws InputError unless rpm is from 300 to 1200.
[[nodiscard]] std::int64_t firings_per_message(const LidarModel& model, double rpm);
/// Time of the last laser's shot after the start of a firing.
[[nodiscard]] Nanoseconds last_laser_ns(const LidarModel& model);

}  // namespace plumbline::slam
