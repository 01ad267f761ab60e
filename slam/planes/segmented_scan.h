// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "slam/io/estimate.h"
#include "slam/scan/motion.h"
#include "slam/scan/plane_observation.h"

namespace plumbline::slam {

/// Least time between two scans whose segmentation is reported.
inline constexpr Nanoseconds segmented_interval = 5'000'000'000;

/// A scan's returns by the planes that were found in it, one column of 16: a return belongs to the nearest plane (ties:
/// the first) that is within 5 cm and whose patch holds it, to 0.1 m; a horizontal patch has no width that would be
/// known.
[[nodiscard]] SegmentedScan segmented_scan(const DeskewedScan& scan, std::span<const PlaneObservation> seen);

}  // namespace plumbline::slam
