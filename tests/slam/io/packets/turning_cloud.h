// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

#include "slam/io/packets/point_cloud.h"

namespace plumbline::slam {

/// A turn of returns whose times go evenly from `first` to `last`.
template <class T>
[[nodiscard]] PointCloud turn(double stamp_s, const std::string& name, PointType type, T first, T last,
                              std::uint32_t points = 40) {
  PointCloud cloud;
  cloud.stamp = std::llround(1e9 * stamp_s);
  cloud.fields = {{"x", 0, PointType::f32}, {"y", 4, PointType::f32}, {"z", 8, PointType::f32}, {name, 12, type}};
  cloud.point_step = 12 + sizeof(T);
  cloud.width = points;
  cloud.height = 1;
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.data.resize(cloud.row_step);
  for (std::uint32_t i = 0; i < points; ++i) {
    std::uint8_t* at = &cloud.data[static_cast<std::size_t>(i) * cloud.point_step];
    const float xyz[3] = {5.0F, 0.1F * static_cast<float>(i), 0.0F};
    const double part = static_cast<double>(i) / (points - 1);
    const T time = static_cast<T>(static_cast<double>(first) + static_cast<double>(last - first) * part);
    std::memcpy(at, xyz, sizeof xyz);
    std::memcpy(at + 12, &time, sizeof time);
  }
  return cloud;
}

/// A cloud whose times begin anew with each second.
[[nodiscard]] inline PointCloud turn_of_second(double stamp_s, std::uint32_t points = 40) {
  PointCloud cloud = turn<std::uint32_t>(stamp_s, "t", PointType::u32, 0, 99'000'000, points);
  for (std::size_t i = 0; i < cloud.width; ++i) {
    std::uint32_t time = 0;
    std::memcpy(&time, &cloud.data[i * cloud.point_step + 12], sizeof time);
    time = static_cast<std::uint32_t>((cloud.stamp + time) % 1'000'000'000);
    std::memcpy(&cloud.data[i * cloud.point_step + 12], &time, sizeof time);
  }
  return cloud;
}

}  // namespace plumbline::slam
