// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "slam/planes/plane_detector.h"

namespace plumbline::slam {

/// Least-squares plane of the returns within the gate of `start`, gated and fitted three times; normal towards the
/// sensor. Nothing when fewer than config.min_points stay. `vertical` is left false.
[[nodiscard]] std::optional<PlaneObservation> fit_patch(const DeskewedScan& scan,
                                                        const std::vector<std::uint32_t>& points, const Plane& start,
                                                        const PlaneDetectorConfig& config);

}  // namespace plumbline::slam
