// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/plan_map/localization_scan.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam::synthetic {

/// What a robot standing at X_WR sees, with its odometry at X_OR.
struct HouseScan {
  std::vector<PlaneObservation> planes;
  LocalizationScan scan;
};
[[nodiscard]] HouseScan house_scan(const House& house, const Pose& X_WR, const Pose& X_OR, std::uint64_t seed = 1);

}  // namespace plumbline::slam::synthetic
