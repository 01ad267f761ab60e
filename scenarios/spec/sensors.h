// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace plumbline::scenarios {

/// What a method is fed: every record, or scans alone, without odometry and IMU.
enum class Sensors { all, lidar };
[[nodiscard]] constexpr std::array<std::string_view, 2> names_of(Sensors) { return {"all", "lidar"}; }

/// Ends the label of a method with LiDAR alone.
inline constexpr std::string_view lidar_ending = ".lidar";

/// A method of the table and what it is fed.
struct MethodChoice {
  std::string method;
  Sensors sensors = Sensors::all;

  /// What files, gates, scores and tables call it: "vgicp", and "vgicp.lidar" with LiDAR alone.
  [[nodiscard]] std::string label() const {
    return sensors == Sensors::lidar ? method + std::string(lidar_ending) : method;
  }
};

[[nodiscard]] inline MethodChoice choice_of(std::string_view label) {
  if (!label.ends_with(lidar_ending)) return {std::string(label), Sensors::all};
  return {std::string(label.substr(0, label.size() - lidar_ending.size())), Sensors::lidar};
}

}  // namespace plumbline::scenarios
