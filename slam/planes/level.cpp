// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/level.h"

#include <algorithm>

#include "bim/geometry/best_rotation.h"

namespace plumbline::slam {

bool is_floor(const PlaneObservation& seen) { return !seen.vertical && seen.plane_R.n.z() > 0.0; }

Eigen::Quaterniond level_by_floor(std::span<const PlaneObservation> seen) {
  const PlaneObservation* widest = nullptr;
  for (const PlaneObservation& plane : seen)
    if (!plane.vertical && (widest == nullptr || plane.points > widest->points)) widest = &plane;
  if (widest == nullptr) return Eigen::Quaterniond::Identity();
  const Eigen::Vector3d up_R = is_floor(*widest) ? widest->plane_R.n : Eigen::Vector3d(-widest->plane_R.n);
  return rotation_between(up_R, Eigen::Vector3d::UnitZ());
}

}  // namespace plumbline::slam
