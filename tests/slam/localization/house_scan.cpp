// SPDX-License-Identifier: Apache-2.0
#include "tests/slam/localization/house_scan.h"

namespace plumbline::slam::synthetic {

HouseScan house_scan(const House& house, const Pose& X_WR, const Pose& X_OR, std::uint64_t seed) {
  WalkConfig config;
  config.seed = seed;
  MotionBuffer motion;
  motion.add({0, X_OR});
  const DeskewedScan deskewed = deskew(standing_scan(house, X_WR, config), motion, calibration());
  HouseScan out;
  out.planes = detect_planes(deskewed, {});
  out.scan = make_localization_scan(deskewed, out.planes, X_OR, calibration(), {});
  return out;
}

}  // namespace plumbline::slam::synthetic
