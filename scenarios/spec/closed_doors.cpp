// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/closed_doors.h"

#include <algorithm>

#include "bim/model/fillings.h"

namespace plumbline::scenarios {

namespace {

constexpr double sill_m = 0.3;  ///< a door whose sill is this far above the floor still stands on it

bool is_shut(const bim::Opening& opening) {
  return opening.wall >= 0 && opening.kind == bim::OpeningKind::door && opening.leaf == bim::Leaf::closed;
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// True when the segment p-q passes through the opening, along its wall's reference line.
bool passes(const Eigen::Vector2d& p, const Eigen::Vector2d& q, const bim::Opening& opening, const bim::Wall& wall) {
  const Eigen::Vector2d e = wall.direction();
  const double dp = cross(e, p - wall.a), dq = cross(e, q - wall.a);
  if ((dp > 0.0) == (dq > 0.0)) return false;
  const double s = e.dot(p + (q - p) * (dp / (dp - dq)) - wall.a);
  return std::abs(s - opening.s_m) <= 0.5 * opening.width_m;
}

}  // namespace

std::vector<std::string> closed_doors_between(const bim::Building& building, const sim::FloorPoint& a,
                                              const sim::FloorPoint& b) {
  bim::Building open = building;
  std::erase_if(open.obstacles, bim::is_filling);
  bim::apply_options(open, {bim::Doors::open, true});
  const std::vector<sim::Waypoint> path = sim::MultiStoreyPlanner(open).path(a, b);
  std::vector<std::string> doors;
  for (const bim::Opening& opening : building.openings) {
    if (!is_shut(opening)) continue;
    const bim::Wall& wall = building.walls[static_cast<std::size_t>(opening.wall)];
    for (std::size_t i = 1; i < path.size(); ++i) {
      const double low = std::min(path[i - 1].p_W.z(), path[i].p_W.z());
      const double high = std::max(path[i - 1].p_W.z(), path[i].p_W.z());
      if (opening.z1_m < low || opening.z0_m > high + sill_m) continue;
      if (!passes(path[i - 1].p_W.head<2>(), path[i].p_W.head<2>(), opening, wall)) continue;
      doors.push_back(opening.id);
      break;
    }
  }
  return doors;
}

std::string open_them(const std::vector<std::string>& doors) {
  std::string list;
  for (const std::string& door : doors) list += (list.empty() ? "'" : ", '") + door + "'";
  return (doors.size() == 1 ? "door " + list + " on the way is" : "doors " + list + " on the way are") +
         " closed; `doors: open` in the scenario opens all, `leaf: open` in the plan one of `doors: as_designed`";
}

}  // namespace plumbline::scenarios
