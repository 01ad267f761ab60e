// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "slam/registration/surfels.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {

/// Of a robot that stands at X_WR in the house with the corridor.
inline std::vector<Surfel> surfels_at(const Pose& X_WR, double range_sigma_m, std::uint64_t seed) {
  synthetic::WalkConfig config;
  config.seed = seed;
  config.range_sigma_m = range_sigma_m;
  MotionBuffer motion;
  motion.add({0, Pose{}});
  return make_surfels(
      deskew(synthetic::standing_scan(synthetic::corridor_house(), X_WR, config), motion, synthetic::calibration()),
      {});
}

}  // namespace plumbline::slam
