// SPDX-License-Identifier: Apache-2.0
#include "bim/model/odd_size.h"

#include <Eigen/Geometry>
#include <cmath>

#include "bim/config/tree.h"

namespace plumbline::bim {

std::string odd_size(const Building& building) {
  constexpr double least_m = 1.0, most_m = 5000.0;
  Eigen::AlignedBox2d box;
  for (const Wall& wall : building.walls) {
    if (!wall.body)
      box.extend(wall.a).extend(wall.b);
    else
      for (const Eigen::Vector3d& p : wall.body->vertices) box.extend(p.head<2>());
  }
  for (const Room& room : building.rooms)
    for (const Eigen::Vector2d& p : room.polygon) box.extend(p);
  for (const Slab& slab : building.slabs)
    for (const Eigen::Vector2d& p : slab.polygon.outer) box.extend(p);
  if (box.isEmpty()) return {};
  const double length = box.sizes().maxCoeff();
  if (length >= least_m && length <= most_m) return {};
  return "the building is " + format_number(std::round(length * 1e3) / 1e3) + " m long; is the unit right?";
}

}  // namespace plumbline::bim
