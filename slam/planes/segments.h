// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "slam/planes/plane_detector.h"
#include "slam/scan/moments.h"

namespace plumbline::slam {

/// Orientation of the surface at a return, from its neighbours in the column.
enum class Facing : std::uint8_t { none, upright, flat };

/// Straight stretch of one ring, seen from above.
struct RingSegment {
  int ring = 0;
  std::vector<std::uint32_t> points;  ///< indices into the scan, in firing order
  Moments moments;
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  ///< unit, of the fitted line in R's xy
  Eigen::Vector3d p0_R = Eigen::Vector3d::Zero();        ///< ends on the fitted line, at the ends' heights
  Eigen::Vector3d p1_R = Eigen::Vector3d::Zero();
};

/// Flat where the rings above or below are level with a return (floor, ceiling, table), none where there is no usable
/// return, upright elsewhere.
[[nodiscard]] std::vector<Facing> classify_returns(const DeskewedScan& scan, const PlaneDetectorConfig& config);

/// Cuts the upright returns of every ring where they jump and where a line does not fit; by ring, then firing order.
[[nodiscard]] std::vector<RingSegment> ring_segments(const DeskewedScan& scan, const std::vector<Facing>& facing,
                                                     const PlaneDetectorConfig& config);

}  // namespace plumbline::slam
