// SPDX-License-Identifier: Apache-2.0
#include "tests/slam/baselines/house_walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/slam/synthetic.h"

namespace plumbline::slam::synthetic {

MethodInput robot() {
  MethodInput given;
  given.calibration = calibration();
  return given;
}

WorstError worst_in_house(Method& method, double duration_s, bool rings) {
  const Recording recording = walk(corridor_house(), corridor_house_walk(), {.duration_s = duration_s});
  WorstError worst;
  for (std::size_t k = 0; k < recording.scans.size(); ++k) {
    const Output output = method.on_scan(rings ? recording.scans[k] : without_rings(recording.scans[k]));
    if (!output.X_FR) {
      ADD_FAILURE() << "scan " << k << " has no pose";
      continue;
    }
    const Eigen::Vector3d off = (recording.truth.front().X_FR * *output.X_FR).t - recording.truth[k].X_FR.t;
    worst.m = std::max(worst.m, off.norm());
    worst.across_m = std::max(worst.across_m, off.head<2>().norm());
    worst.height_m = std::max(worst.height_m, std::abs(off.z()));
  }
  EXPECT_EQ(method.finish().trajectory.size(), recording.scans.size());
  return worst;
}

}  // namespace plumbline::slam::synthetic
