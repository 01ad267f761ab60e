// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/entered_room.h"

#include <algorithm>
#include <cmath>

#include "sim/route/clearance_map.h"

namespace plumbline::scenarios {

namespace {

constexpr double sample_m = 0.1;  ///< of the walk

/// Whether a walk gets so far into a room.
bool enters(const std::vector<sim::Waypoint>& way, const bim::Room& room, double floor_z, double inside_m) {
  const auto is_in = [&](const Eigen::Vector2d& p) {
    return room.contains(p) && room.boundary_distance(p) >= inside_m;
  };
  if (way.size() == 1) return is_in(way.front().p_W.head<2>());
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Eigen::Vector3d &a = way[i - 1].p_W, &b = way[i].p_W;
    const int count = 1 + static_cast<int>((b - a).norm() / sample_m);
    for (int k = 0; k <= count; ++k) {
      const Eigen::Vector3d p = a + (b - a) * (static_cast<double>(k) / count);
      if (std::abs(p.z() - floor_z) < 1.0 && is_in(p.head<2>())) return true;
    }
  }
  return false;
}

/// How far inside a room the robot can be, up to well inside, m.
double depth(const sim::ClearanceMap& floor, const bim::Room& room) {
  const double well_inside_m = floor.config().inside_m;
  const GridFrame& grid = floor.grid();
  if (grid.size() == 0) return 0.0;
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : room.polygon) box.extend(p);
  if (box.isEmpty()) return 0.0;
  double deepest_m = 0.0;
  for (int j = std::max(0, grid.row(box.min().y())); j <= std::min(grid.ny - 1, grid.row(box.max().y())); ++j)
    for (int i = std::max(0, grid.column(box.min().x())); i <= std::min(grid.nx - 1, grid.column(box.max().x())); ++i) {
      if (deepest_m >= well_inside_m) return well_inside_m;
      const std::size_t cell = grid.index(i, j);
      if (const Eigen::Vector2d p = grid.center(cell); floor.passable(cell) && room.contains(p))
        deepest_m = std::max(deepest_m, room.boundary_distance(p));
    }
  return std::min(deepest_m, well_inside_m);
}

}  // namespace

bool enters_room(const sim::MultiStoreyPlanner& space, const std::vector<sim::Waypoint>& way, int room) {
  const bim::Room& of = space.building().rooms[static_cast<std::size_t>(room)];
  const double floor_z = space.building().storeys[static_cast<std::size_t>(of.storey)].elevation_m;
  if (!enters(way, of, floor_z, 0.0)) return false;
  const sim::ClearanceMap& floor = space.storey(of.storey);
  return enters(way, of, floor_z, depth(floor, of) - floor.grid().cell);
}

}  // namespace plumbline::scenarios
