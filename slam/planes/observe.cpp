// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/observe.h"

namespace plumbline::slam {

std::vector<PlaneObservation> observe_planes(const DeskewedScan& scan, const PlaneDetectorConfig& config,
                                             const RansacConfig& without_rings, std::uint64_t seed) {
  return has_rings(scan) ? detect_planes(scan, config) : ransac_planes(scan, without_rings, config, seed);
}

}  // namespace plumbline::slam
