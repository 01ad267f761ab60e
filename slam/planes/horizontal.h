// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "slam/planes/plane_detector.h"
#include "slam/planes/segments.h"

namespace plumbline::slam {

/// Floor and ceiling, at most one each, by a robust fit to the flat returns below and above the sensor.
[[nodiscard]] std::vector<PlaneObservation> horizontal_planes(const DeskewedScan& scan,
                                                              const std::vector<Facing>& facing,
                                                              const PlaneDetectorConfig& config);

}  // namespace plumbline::slam
