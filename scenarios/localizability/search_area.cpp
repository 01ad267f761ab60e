// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/search_area.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "sim/world.h"

namespace plumbline::scenarios {

std::vector<double> SearchArea::lines(int axis, double spacing_m) const {
  std::vector<double> found;
  for (double at = corner[axis] - 0.5 * spacing_m; at > min[axis]; at -= spacing_m) found.push_back(at);
  std::reverse(found.begin(), found.end());
  for (double at = corner[axis] + 0.5 * spacing_m; at < max[axis]; at += spacing_m) found.push_back(at);
  return found;
}

SearchArea search_area(const bim::Building& building, std::size_t storey) {
  const auto here = [&](const auto& thing) { return thing.storey == static_cast<int>(storey); };
  Eigen::AlignedBox2d lines, all;
  for (const bim::Wall& wall : building.walls) {
    if (!here(wall)) continue;
    lines.extend(wall.a).extend(wall.b);
    // Curved walls go past their chord. Where a wall is straight no place lies in its thickness.
    if (wall.body)
      for (const Eigen::Vector3d& p : wall.body->vertices) all.extend(Eigen::Vector2d(p.head<2>()));
  }
  for (const bim::Room& room : building.rooms)
    if (here(room))
      for (const Eigen::Vector2d& p : room.polygon) all.extend(p);
  all.extend(lines);
  SearchArea area;
  area.sensor_z_W = building.storeys[storey].elevation_m + sim::World::calibration().sensor_height_m;
  area.min = all.isEmpty() ? Eigen::Vector2d::Constant(1e9) : all.min();
  area.max = all.isEmpty() ? Eigen::Vector2d::Constant(-1e9) : all.max();
  area.corner = lines.isEmpty() ? area.min : lines.min();
  return area;
}

}  // namespace plumbline::scenarios
