// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/symmetric_images.h"

#include "bim/symmetry/symmetry.h"

namespace plumbline::scenarios {

namespace {

Pose pose_of(const bim::Building& plan, const bim::StoreySymmetry& symmetry) {
  const auto elevation_m = [&](int storey) { return plan.storeys[static_cast<std::size_t>(storey)].elevation_m; };
  const Eigen::Vector2d& t = symmetry.isometry.t;
  return Pose::from_xyz_yaw({t.x(), t.y(), elevation_m(symmetry.to) - elevation_m(symmetry.from)},
                            symmetry.isometry.angle);
}

}  // namespace

std::vector<Pose> storey_isometries(const bim::Building& plan) {
  const bim::SymmetryReport report = bim::analyse_symmetry(plan);
  std::vector<Pose> isometries;
  for (const bim::StoreySymmetry& symmetry : report.storeys) isometries.push_back(pose_of(plan, symmetry));
  for (const bim::StoreySymmetry& up : report.copies) {
    isometries.push_back(pose_of(plan, up));
    isometries.push_back(pose_of(plan, up).inverse());
    for (const bim::StoreySymmetry& other : report.copies)
      if (other.from == up.from && other.to != up.to)
        isometries.push_back(pose_of(plan, other) * pose_of(plan, up).inverse());
  }
  return isometries;
}

}  // namespace plumbline::scenarios
