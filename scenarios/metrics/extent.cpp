// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/extent.h"

#include <Eigen/Geometry>
#include <cmath>

#include "bim/config/tree.h"
#include "bim/errors.h"

namespace plumbline::scenarios {

void check_extent(const bim::BuildingMesh& mesh) {
  constexpr double most_m3 = 8e6;  // at a bit for 0.1 m
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : mesh.vertices) box.extend(v);
  if (box.isEmpty()) return;
  const Eigen::Vector3d size = box.sizes().cwiseMax(1.0);
  if (size.prod() <= most_m3) return;
  throw InputError({}, "the building reaches over " + format_number(std::round(size.x())) + " x " +
                           format_number(std::round(size.y())) + " x " + format_number(std::round(size.z())) +
                           " m, which is more than 8 million m3; leave out what stands far off");
}

}  // namespace plumbline::scenarios
