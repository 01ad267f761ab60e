// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/observe.h"

namespace plumbline::slam {

std::vector<PlaneObservation> observe_planes(const DeskewedScan& scan, const PlaneDetectorConfig& config,
                                             const RansacConfig& without_rings, std::uint64_t seed) {
  constexpr int fewest_rings = 4;
  return scan.rings < fewest_rings ? ransac_planes(scan, without_rings, config, seed) : detect_planes(scan, config);
}

}  // namespace plumbline::slam
