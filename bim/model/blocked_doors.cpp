// SPDX-License-Identifier: Apache-2.0
#include "bim/model/blocked_doors.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "bim/geometry/interval.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/model/boxes.h"
#include "bim/model/wall_face.h"

namespace plumbline::bim {

namespace {

bool is_open(const Opening& opening) {
  return opening.wall >= 0 && opening.kind != OpeningKind::window && opening.leaf != Leaf::closed;
}

/// The doorway on the plan, longer across the wall by `beyond_m` on both sides.
Polygon2 doorway_in(const Wall& wall, const Opening& opening, double beyond_m) {
  Wall stretch = wall;
  const double half = 0.5 * opening.width_m;
  stretch.a = wall.a + (opening.s_m - half) * wall.direction();
  stretch.b = wall.a + (opening.s_m + half) * wall.direction();
  stretch.offset_m -= beyond_m;
  stretch.thickness_m += 2.0 * beyond_m;
  return footprint(stretch);
}

/// The longest part of 0 to `width_m` that no interval covers.
double longest_free(std::vector<Interval> blocked, double width_m) {
  std::sort(blocked.begin(), blocked.end());
  double at = 0.0, longest = 0.0;
  for (const Interval& part : blocked) {
    longest = std::max(longest, part.low - at);
    at = std::max(at, part.high);
  }
  return std::max(longest, width_m - at);
}

}  // namespace

void warn_of_blocked_doors(Building& building, const BlockedDoorConfig& config) {
  const BoxIndex boxes = boxes_of(building.walls);
  for (const Opening& door : building.openings) {
    if (!is_open(door)) continue;
    const Wall& host = building.walls[static_cast<std::size_t>(door.wall)];
    if (door.kind == OpeningKind::opening_void && host.storey >= 0 &&
        door.z0_m > building.storeys[static_cast<std::size_t>(host.storey)].elevation_m + config.sill_m)
      continue;
    const Polygon2 doorway = doorway_in(host, door, config.before_m);
    const Region2 region = unite(std::vector<Polygon2>{doorway});
    const auto in_the_way = [&](const auto& element) {
      return element.z0_m < door.z0_m + config.high_m && element.z1_m > door.z0_m + config.low_m;
    };
    std::vector<Interval> blocked;
    std::string first;
    const auto add = [&](const Region2& body, const std::string& name) {
      for (const PolygonWithHoles2& piece : intersect(region, body)) {
        Interval& part = blocked.emplace_back();
        for (const Eigen::Vector2d& p : piece.outer)
          part.add(host.direction().dot(p - host.a) - door.s_m + 0.5 * door.width_m);
        if (first.empty()) first = name;
      }
    };
    for (const int i : boxes.near(doorway, 0.0)) {
      const Wall& other = building.walls[static_cast<std::size_t>(i)];
      if (i == door.wall || other.storey != host.storey || !in_the_way(other)) continue;
      std::vector<Polygon2> gaps;
      for (const Opening& gap : building.openings)
        if (gap.wall == i && is_open(gap) && gap.z0_m < door.z0_m + config.low_m &&
            gap.z1_m > door.z0_m + config.head_m)
          gaps.push_back(doorway_in(other, gap, config.low_m));
      add(subtract(unite(std::vector<Polygon2>{footprint(other)}), gaps), "wall '" + other.id + "'");
    }
    for (const Column& column : building.columns)
      if (column.storey == host.storey && in_the_way(column))
        add(unite(std::vector<Polygon2>{column.footprint}), "column '" + column.id + "'");
    if (blocked.empty() || longest_free(blocked, door.width_m) >= config.passable_m) continue;
    building.warnings.push_back({door.id, "blocked_door", first + " stands in it; a robot does not pass"});
  }
}

}  // namespace plumbline::bim
