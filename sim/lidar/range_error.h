// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/lidar/lidar_config.h"

namespace plumbline::sim {

/// Systematic error of a range, m: by distance, by reflectivity, by the cosine of the incidence, and by the time since
/// the sensor was switched on; docs/methods/lidar_model.md. Not random.
[[nodiscard]] double range_error(const LidarConfig& config, double time_s, double range_m, double reflectivity,
                                 double cosine);

}  // namespace plumbline::sim
