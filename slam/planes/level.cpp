// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/level.h"

#include <algorithm>

namespace plumbline::slam {

bool is_floor(const PlaneObservation& seen) { return !seen.vertical && seen.plane_R.n.z() > 0.0; }

Eigen::Quaterniond level_by_floor(std::span<const PlaneObservation> seen) {
  const auto floor = std::find_if(seen.begin(), seen.end(), is_floor);
  if (floor == seen.end()) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond::FromTwoVectors(floor->plane_R.n, Eigen::Vector3d::UnitZ());
}

}  // namespace plumbline::slam
