// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "slam/io/packets/cloud_order.h"
#include "slam/io/packets/point_cloud.h"

namespace plumbline::slam {

/// The number of this type at `bytes`.
[[nodiscard]] double number_at(const std::uint8_t* bytes, PointType type);

/// The points' ring or time, or null.
[[nodiscard]] const PointField* ring_field(const PointCloud& cloud);
[[nodiscard]] const PointField* time_field(const PointCloud& cloud);
/// "fields timeSecond, timeNanosecond" of a cloud that has such; else empty.
[[nodiscard]] std::string unread_times(const PointCloud& cloud);

/// Whether x, y and z are whole numbers of 16 or 32 bits. Whole metres would be no measurement: depth cameras and raw
/// data of Livox have mm so.
[[nodiscard]] bool is_in_mm(const PointCloud& cloud);

/// Throws InputError without a mark where the bytes are not those of the points and fields.
void check_cloud(const PointCloud& cloud);

/// Of point i of a checked cloud.
[[nodiscard]] const std::uint8_t* bytes_of(const PointCloud& cloud, std::size_t i);

/// The points of a checked cloud, without their times. Throws InputError as scan_of() does.
[[nodiscard]] std::vector<CloudPoint> read_untimed(const PointCloud& cloud);

}  // namespace plumbline::slam
