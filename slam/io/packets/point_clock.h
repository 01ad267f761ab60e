// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "slam/io/packets/cloud_fields.h"

namespace plumbline::slam {

inline constexpr Nanoseconds longest_sweep_ns = 1'000'000'000;

/// What the numbers of a time field mean.
struct PointClock {
  const PointField* field = nullptr;
  double unit_ns = 1.0;
  double zero_ns = 0.0;    ///< the cloud's stamp where the times are those of the day or of the second, else 0
  bool of_second = false;  ///< the times begin anew with each second

  /// Not a number where it is none of a second.
  [[nodiscard]] double nanoseconds(const std::uint8_t* point) const {
    const double number = unit_ns * number_at(point + field->offset, field->type);
    if (!of_second) return number - zero_ns;
    const bool is_time = number >= 0.0 && number < 1e9;
    return is_time ? std::remainder(number - zero_ns, 1e9) : std::numeric_limits<double>::quiet_NaN();
  }
};

/// Least and greatest time of the returns, ns from the stamp, of all within most_ns of it: some drivers give a few no
/// time. (0, 0) without a return, (-inf, 0) where more than one in a hundred is not within.
[[nodiscard]] std::pair<double, double> returns_extent(const PointCloud& cloud, const PointClock& clock,
                                                       const std::vector<CloudPoint>& points, double most_ns);

/// By which the times of a cloud's points are read. Throws InputError without a mark where none puts all returns within
/// 1 s of the stamp.
[[nodiscard]] PointClock clock_of(const PointCloud& cloud, const PointField& field,
                                  const std::vector<CloudPoint>& points, const PointTimes& times);

}  // namespace plumbline::slam
