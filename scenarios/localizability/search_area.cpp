// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/search_area.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sim/world.h"

namespace plumbline::scenarios {

double SearchArea::sensor_z_W(const Eigen::Vector2d& p_W) const {
  return bim::height_at(floors, p_W) + sim::World::calibration().sensor_height_m;
}

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
  area.floors = bim::walked_floors(building, static_cast<int>(storey));
  area.min = all.isEmpty() ? Eigen::Vector2d::Constant(1e9) : all.min();
  area.max = all.isEmpty() ? Eigen::Vector2d::Constant(-1e9) : all.max();
  area.corner = lines.isEmpty() ? area.min : lines.min();
  return area;
}

std::vector<bim::WalkedFloors> storey_floors(const bim::Building& building) {
  std::vector<bim::WalkedFloors> floors;
  for (std::size_t i = 0; i < building.storeys.size(); ++i)
    floors.push_back(bim::walked_floors(building, static_cast<int>(i)));
  return floors;
}

double sensor_z_W(const std::vector<bim::WalkedFloors>& floors, const Eigen::Vector3d& p_W, double near_m) {
  double floor = p_W.z(), off = near_m;
  for (const bim::WalkedFloors& storey : floors) {
    const double height = bim::height_at(storey, p_W.head<2>());
    if (std::abs(height - p_W.z()) >= off) continue;
    off = std::abs(height - p_W.z());
    floor = height;
  }
  return floor + sim::World::calibration().sensor_height_m;
}

}  // namespace plumbline::scenarios
