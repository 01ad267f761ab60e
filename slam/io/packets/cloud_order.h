// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "slam/io/records.h"

namespace plumbline::slam {

inline constexpr std::uint64_t most_cloud_points = 4'000'000;
inline constexpr int most_cloud_rings = 128;

/// One point of a cloud.
struct CloudPoint {
  Eigen::Vector3d p_L = Eigen::Vector3d::Zero();
  bool valid = false;
  float reflectivity = 0.0F;
  int ring = -1;         ///< -1 until it is known
  Nanoseconds time = 0;  ///< from the cloud's stamp
  int column = 0;
};

/// What a cloud tells of the order of its points.
struct CloudLines {
  std::uint32_t width = 0;   ///< points a row
  std::uint32_t height = 0;  ///< rows
  bool named_rings = false;  ///< the points have their rings
  bool timed = false;        ///< the points have their times
};

struct CloudOrder {
  int rings = 1;
  int columns = 0;
  bool rings_left_out = false;  ///< the points' own, one number for all of them or not within 0 to 127
};

/// Gives width x height points the slots of a scan: rings from the lowest, by name, by the layout of an organised
/// cloud, by the elevations of a VLP-16 or by cones of equal elevation, else one ring; columns by layout, time or
/// azimuth, of one ring a column a point. Rings that are the same for returns of many elevations, or not within 0 to
/// 127, are no names; who counts from 1 may have 128. A point that has no slot gets ring -1. Throws InputError without
/// a mark where most points are on one ring.
[[nodiscard]] CloudOrder order_points(std::vector<CloudPoint>& points, const CloudLines& lines);

}  // namespace plumbline::slam
