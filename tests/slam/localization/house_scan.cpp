// SPDX-License-Identifier: Apache-2.0
#include "tests/slam/localization/house_scan.h"

namespace plumbline::slam::synthetic {

Standing standing_view(const House& house, const Pose& X_WR, const Pose& X_OR, std::uint64_t seed) {
  WalkConfig config;
  config.seed = seed;
  MotionBuffer motion;
  motion.add({0, X_OR});
  const DeskewedScan scan = deskew(standing_scan(house, X_WR, config), motion, calibration());
  Standing standing;
  standing.planes = detect_planes(scan, {});
  standing.view = make_view(scan, standing.planes, X_OR, calibration(), {});
  return standing;
}

}  // namespace plumbline::slam::synthetic
