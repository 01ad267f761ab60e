// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "slam/planes/plane_detector.h"
#include "slam/planes/ransac.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

/// RANSAC where scans have no rings. Chosen on recordings of a car's 64-ring LiDAR whose clouds name no rings.
struct RinglessRansacConfig : RansacConfig {
  RinglessRansacConfig() {
    voxel_m = 0.3;
    distance_m = 0.04;
    iterations = 100;
    min_left = 1500;
    min_inliers = min_horizontal = 200;
  }
};

/// Planes of a scan: from stretches of its rings, or by RANSAC where it has too few rings for that.
[[nodiscard]] std::vector<PlaneObservation> observe_planes(const DeskewedScan& scan, const PlaneDetectorConfig& config,
                                                           const RansacConfig& without_rings, std::uint64_t seed);

}  // namespace plumbline::slam
