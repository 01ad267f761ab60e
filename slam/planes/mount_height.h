// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "slam/io/recordings/recording.h"
#include "slam/io/records.h"

namespace plumbline::slam {

/// Height of the LiDAR above the floor, m, by scans of a robot at its start: the median of those that see a floor; none
/// where fewer than a third do. The floor is the largest horizontal plane below the LiDAR, or, on a
/// road, which is no plane, where the lowest returns around it lie.
[[nodiscard]] std::optional<double> height_over_floor(std::span<const Scan> scans, const Calibration& calibration,
                                                      std::uint64_t seed);

/// The same by the first ten scans of a recording that show a floor in a quarter of the directions they see, or else by
/// those ten of its first half minute that show it in most, of each thirty scans ten: a robot may start where furniture
/// hides the floor, and what is seen through a window lies lower.
[[nodiscard]] std::optional<double> height_over_floor(Recording& recording, const Calibration& calibration,
                                                      std::uint64_t seed);

}  // namespace plumbline::slam
