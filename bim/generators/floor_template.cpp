// SPDX-License-Identifier: Apache-2.0
#include "bim/generators/floor_template.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "bim/errors.h"

namespace plumbline::bim {

namespace {

/// Written coordinates have this many steps to the metre, so that they read well.
constexpr double steps = 1e6;

double rounded(double v) { return std::round(v * steps) / steps; }
Eigen::Vector2d rounded(const Eigen::Vector2d& p) { return {rounded(p.x()), rounded(p.y())}; }

/// Stretches of a room's edge between neighbouring corners of any room.
std::vector<Eigen::Vector2d> divided(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const FloorTemplate& floor) {
  const double length = (b - a).norm();
  const Eigen::Vector2d e = (b - a) / length;
  std::vector<double> cuts = {0.0, length};
  for (const TemplateRoom& room : floor.rooms) {
    for (const Eigen::Vector2d& p : room.outline) {
      const double s = e.dot(p - a);
      if (s > same_m && s < length - same_m && segment_distance(a, b, p) < same_m) cuts.push_back(s);
    }
  }
  std::sort(cuts.begin(), cuts.end());
  std::vector<Eigen::Vector2d> points;
  for (const double s : cuts)
    if (points.empty() || (a + s * e - points.back()).norm() > same_m) points.emplace_back(rounded(a + s * e));
  return points;
}

bool are_open(const FloorTemplate& floor, const TemplateWall& wall) {
  if (wall.rooms[0] < 0 || wall.rooms[1] < 0) return false;
  const std::string& a = floor.rooms[static_cast<std::size_t>(wall.rooms[0])].id;
  const std::string& b = floor.rooms[static_cast<std::size_t>(wall.rooms[1])].id;
  return std::any_of(floor.open.begin(), floor.open.end(),
                     [&](const auto& pair) { return pair == std::pair(a, b) || pair == std::pair(b, a); });
}

double thickness(const TemplateWall& wall, const GeneratorOptions& options) {
  return wall.rooms[1] < 0 ? options.facade_m : options.partition_m;
}

/// How far the middle of a wall stands outside its reference line: rooms are clear half an inner wall's thickness
/// within theirs on all sides, so that rooms at the end of a row are equal to the others.
double outward_shift(const TemplateWall& wall, const GeneratorOptions& options) {
  return wall.rooms[1] < 0 ? 0.5 * (options.facade_m - options.partition_m) : 0.0;
}

/// How far a wall goes on beyond p, where it meets one other at a right angle, to fill the corner; 0 where more or
/// none do.
double corner_reach(const std::vector<TemplateWall>& walls, std::size_t i, const Eigen::Vector2d& p,
                    const GeneratorOptions& options) {
  const Eigen::Vector2d e = walls[i].b - walls[i].a;
  double reach = 0.0;
  int others = 0;
  for (std::size_t j = 0; j < walls.size(); ++j) {
    const bool begins = (walls[j].a - p).norm() < same_m, ends = (walls[j].b - p).norm() < same_m;
    if (j == i || (!begins && !ends)) continue;
    ++others;
    const Eigen::Vector2d f = walls[j].b - walls[j].a;
    if (std::abs(e.dot(f)) > same_m * e.norm() * f.norm()) continue;
    // Rooms lie left of their walls: where the outline turns left the other wall's outer face is the far one.
    const double left = e.x() * f.y() - e.y() * f.x();
    const bool convex = (begins ? left : -left) > 0.0;
    reach = 0.5 * thickness(walls[j], options) + (convex ? 1.0 : -1.0) * outward_shift(walls[j], options);
  }
  return others == 1 ? reach : 0.0;
}

std::string wall_name(const FloorTemplate& floor, const TemplateWall& wall, std::map<std::string, int>& taken) {
  std::string name = floor.rooms[static_cast<std::size_t>(wall.rooms[0])].id + "-" +
                     (wall.rooms[1] < 0 ? "outside" : floor.rooms[static_cast<std::size_t>(wall.rooms[1])].id);
  const int number = ++taken[name];
  return number == 1 ? name : name + "-" + std::to_string(number);
}

}  // namespace

void FloorTemplate::add_room(std::string id, Polygon2 outline) { rooms.push_back({std::move(id), std::move(outline)}); }

void FloorTemplate::add_door(std::string id, const Eigen::Vector2d& at, double width_m) {
  openings.push_back({std::move(id), OpeningKind::door, at, width_m, 2.1, 0.0});
}

void FloorTemplate::add_window(std::string id, const Eigen::Vector2d& at, double width_m) {
  openings.push_back({std::move(id), OpeningKind::window, at, width_m, 1.2, 0.9});
}

void FloorTemplate::add_column(std::string id, const Eigen::Vector2d& at, double side_m, double yaw_deg) {
  PlanColumnEntry& column = columns.emplace_back();
  column.id = std::move(id);
  column.at = at;
  column.size = {side_m, side_m};
  column.yaw_deg = yaw_deg;
}

void FloorTemplate::add_box(std::string id, const Eigen::Vector2d& at, double side_m, double yaw_deg) {
  PlanClutterEntry& box = clutter.emplace_back();
  box.id = std::move(id);
  box.at = at;
  box.size = {side_m, side_m};
  box.yaw_deg = yaw_deg;
}

void FloorTemplate::add_copy(const FloorTemplate& other, const Isometry2& g, const std::string& suffix) {
  for (const TemplateRoom& room : other.rooms) add_room(room.id + suffix, g * room.outline);
  for (TemplateOpening opening : other.openings) {
    opening.id += suffix;
    opening.at = g * opening.at;
    openings.push_back(opening);
  }
  for (PlanColumnEntry column : other.columns) {
    column.id += suffix;
    column.at = g * column.at;
    columns.push_back(column);
  }
}

int FloorTemplate::find_room(const std::string& id) const {
  for (std::size_t i = 0; i < rooms.size(); ++i)
    if (rooms[i].id == id) return static_cast<int>(i);
  throw InternalError("a family has no room '" + id + "'");
}

Polygon2 rectangle(double x0, double y0, double x1, double y1) { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }

std::vector<TemplateWall> walls_of(const FloorTemplate& floor) {
  std::vector<TemplateWall> walls;
  std::map<std::array<std::int64_t, 4>, std::size_t> known;
  const auto step = [](double v) { return static_cast<std::int64_t>(std::llround(v * steps)); };
  for (std::size_t r = 0; r < floor.rooms.size(); ++r) {
    const Polygon2& outline = floor.rooms[r].outline;
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const auto points = divided(outline[k], outline[(k + 1) % outline.size()], floor);
      for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const Eigen::Vector2d &a = points[i], &b = points[i + 1];
        // A neighbour runs along the same stretch the other way.
        const auto other = known.find({step(b.x()), step(b.y()), step(a.x()), step(a.y())});
        if (other != known.end()) {
          walls[other->second].rooms[1] = static_cast<int>(r);
          continue;
        }
        known[{step(a.x()), step(a.y()), step(b.x()), step(b.y())}] = walls.size();
        walls.push_back({a, b, {static_cast<int>(r), -1}});
      }
    }
  }
  std::erase_if(walls, [&](const TemplateWall& wall) { return are_open(floor, wall); });
  return walls;
}

int wall_at(const std::vector<TemplateWall>& walls, const Eigen::Vector2d& p) {
  constexpr double on_m = 1e-4;
  for (std::size_t i = 0; i < walls.size(); ++i)
    if (segment_distance(walls[i].a, walls[i].b, p) < on_m) return static_cast<int>(i);
  return -1;
}

void add_storey_entries(const FloorTemplate& floor, const GeneratorOptions& options, const std::string& storey,
                        const std::string& prefix, PlanFile& plan) {
  const std::vector<TemplateWall> walls = walls_of(floor);
  const std::size_t first = plan.walls.size();
  std::map<std::string, int> taken;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const Eigen::Vector2d e = (walls[i].b - walls[i].a).normalized();
    PlanWallEntry entry;
    entry.id = prefix + wall_name(floor, walls[i], taken);
    entry.storey = storey;
    const Eigen::Vector2d out = outward_shift(walls[i], options) * Eigen::Vector2d(e.y(), -e.x());
    entry.a = rounded(walls[i].a + out - corner_reach(walls, i, walls[i].a, options) * e);
    entry.b = rounded(walls[i].b + out + corner_reach(walls, i, walls[i].b, options) * e);
    entry.thickness_m = thickness(walls[i], options);
    entry.material = walls[i].rooms[1] < 0 ? "concrete" : options.glass ? "glass" : "plaster";
    plan.walls.push_back(std::move(entry));
  }
  for (const TemplateOpening& opening : floor.openings) {
    const int wall = wall_at(walls, opening.at);
    if (wall < 0) throw InternalError("the opening '" + opening.id + "' of a family lies on no wall");
    const PlanWallEntry& host = plan.walls[first + static_cast<std::size_t>(wall)];
    PlanOpeningEntry entry;
    entry.id = prefix + opening.id;
    entry.wall = host.id;
    entry.kind = opening.kind;
    entry.s_m = rounded((opening.at - host.a).dot((host.b - host.a).normalized()));
    entry.width_m = opening.width_m;
    entry.height_m = opening.height_m;
    entry.sill_m = opening.sill_m;
    plan.openings.push_back(std::move(entry));
  }
  for (const TemplateRoom& room : floor.rooms) {
    PlanRoomEntry entry{prefix + room.id, storey, {}, {}};
    for (const Eigen::Vector2d& p : room.outline) entry.polygon.push_back(rounded(p));
    plan.rooms.push_back(std::move(entry));
  }
  for (PlanColumnEntry column : floor.columns) {
    column.id = prefix + column.id;
    column.storey = storey;
    column.at = rounded(column.at);
    plan.columns.push_back(std::move(column));
  }
  for (PlanClutterEntry clutter : floor.clutter) {
    clutter.id = prefix + clutter.id;
    clutter.storey = storey;
    clutter.at = rounded(clutter.at);
    plan.clutter.push_back(std::move(clutter));
  }
}

}  // namespace plumbline::bim
