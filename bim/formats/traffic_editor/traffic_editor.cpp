// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/traffic_editor/traffic_editor.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "bim/errors.h"
#include "bim/formats/traffic_editor/traffic_editor_file.h"
#include "bim/formats/traffic_editor/traffic_editor_gaps.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/model/infer_rooms.h"
#include "bim/model/rooms.h"
#include "bim/model/wall_face.h"

namespace plumbline::bim {

namespace {

constexpr double shortest_wall_m = 0.01;

Polygon2 outline(const TrafficLevel& level, const std::vector<std::size_t>& around) {
  Polygon2 polygon;
  for (const std::size_t v : around) polygon.push_back(level.vertices[v].p_W);
  return polygon;
}

double coordinate(double x) { return snap(x); }

/// Makes the levels of a file storeys, one after the other.
class TrafficBuilder {
 public:
  TrafficBuilder(const TrafficFile& file, const TrafficEditorConfig& config) : file_(file), config_(config) {}

  Building build() {
    building_.name = file_.name;
    building_.schema = "traffic_editor";
    building_.unit = file_.metres ? "m" : "px";
    for (std::size_t i = 0; i < file_.levels.size(); ++i) add_level(i);
    if (!file_.lifts.empty()) warn("", "left_out", count(file_.lifts.size(), "lift") + " left out: not simulated");
    find_room_walls(building_);
    find_opening_rooms(building_);
    return std::move(building_);
  }

 private:
  static std::string count(std::size_t n, const std::string& what) {
    return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
  }

  void warn(const std::string& element, WarningKind kind, const std::string& text) {
    building_.warnings.push_back({element, kind, text});
  }

  void add_level(std::size_t i) {
    const TrafficLevel& level = file_.levels[i];
    storey_ = static_cast<int>(i);
    building_.storeys.push_back({level.name, level.name, level.elevation_m, height_of(i)});
    first_wall_ = building_.walls.size();
    add_walls(level);
    add_doors(level);
    add_doorways(level);
    close_corners();
    add_slabs(level);
    add_rooms(level);
    if (level.models > 0)
      warn(level.name, "left_out", count(level.models, "model") + " left out: the plan does not hold their shape");
  }

  /// Up to the next level where that is lower than a wall's usual height.
  double height_of(std::size_t i) {
    const TrafficLevel& level = file_.levels[i];
    if (i + 1 == file_.levels.size()) return config_.wall_height_m;
    const double rise = file_.levels[i + 1].elevation_m - level.elevation_m;
    if (rise >= config_.wall_height_m) return config_.wall_height_m;
    if (rise >= config_.lowest_room_m) return rise;
    warn(level.name, "levels_overlap",
         "the next level begins " + format_number(rise) + " m above it; its walls reach into that one");
    return config_.wall_height_m;
  }

  [[nodiscard]] const Storey& storey() const { return building_.storeys.back(); }

  Wall make_wall(std::string id, const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
    Wall wall;
    wall.id = std::move(id);
    wall.name = wall.id;
    wall.storey = storey_;
    wall.a = a.unaryExpr(&coordinate);
    wall.b = b.unaryExpr(&coordinate);
    wall.thickness_m = config_.wall_thickness_m;
    wall.offset_m = -0.5 * config_.wall_thickness_m;
    wall.z0_m = storey().elevation_m;
    wall.z1_m = wall.z0_m + storey().height_m;
    return wall;
  }

  void add_walls(const TrafficLevel& level) {
    std::set<std::pair<std::size_t, std::size_t>> known;
    for (std::size_t i = 0; i < level.walls.size(); ++i) {
      const TrafficEdge& edge = level.walls[i];
      Wall wall =
          make_wall(level.name + "/wall" + std::to_string(i), level.vertices[edge.a].p_W, level.vertices[edge.b].p_W);
      const bool repeated = !known.insert(std::minmax(edge.a, edge.b)).second;
      if (repeated || wall.length() < shortest_wall_m)
        warn(wall.id, "left_out", repeated ? "repeats another wall" : "has no length");
      else
        building_.walls.push_back(std::move(wall));
    }
    first_lintel_ = building_.walls.size();
    if (first_lintel_ == first_wall_) warn(level.name, "no_walls", "the level has no walls");
  }

  void add_opening(std::string id, OpeningKind kind, int wall, double s_m, double width_m) {
    Opening opening;
    opening.id = std::move(id);
    opening.wall = wall;
    opening.kind = kind;
    opening.s_m = s_m;
    opening.width_m = width_m;
    opening.z0_m = storey().elevation_m;
    opening.z1_m = opening.z0_m + std::min(config_.door_height_m, storey().height_m);
    opening.leaf = kind == OpeningKind::door ? Leaf::open : Leaf::none;
    building_.openings.push_back(std::move(opening));
  }

  void add_doors(const TrafficLevel& level) {
    std::map<std::string, int> uses;
    for (std::size_t i = 0; i < level.doors.size(); ++i) {
      const TrafficEdge& edge = level.doors[i];
      std::string id = level.name + "/" + (edge.name.empty() ? "door" + std::to_string(i) : edge.name);
      if (const int use = ++uses[id]; use > 1) id += "#" + std::to_string(use);
      const Segment door{level.vertices[edge.a].p_W, level.vertices[edge.b].p_W};
      if (door.length() < shortest_wall_m) {
        warn(id, "left_out", "the door has no width");
        continue;
      }
      const std::vector<WallSpan> spans = spans_in_walls(door);
      if (spans.empty())
        add_filled_gap(id, OpeningKind::door, door);
      else
        open_walls(id, door, spans);
    }
  }

  /// An opening in each of the walls.
  void open_walls(const std::string& id, const Segment& door, const std::vector<WallSpan>& spans) {
    double width = 0.0;
    for (std::size_t k = 0; k < spans.size(); ++k) {
      const WallSpan& span = spans[k];
      width += span.s1 - span.s0;
      add_opening(k == 0 ? id : id + "/" + std::to_string(k + 1), OpeningKind::door, span.wall,
                  0.5 * (span.s0 + span.s1), span.s1 - span.s0);
    }
    const auto in_cm = [](double m) { return format_number(0.01 * std::round(100.0 * m)) + " m"; };
    if (width < door.length() - config_.touching_m)
      warn(id, "left_out",
           "only " + in_cm(width) + " of the door's " + in_cm(door.length()) + " lie in walls; the rest is left out");
  }

  /// Parts of the door, the longest first, that lie in walls in line; none where they are less than half of it.
  std::vector<WallSpan> spans_in_walls(const Segment& door) const {
    std::vector<WallSpan> found, spans;
    for (std::size_t w = first_wall_; w < building_.walls.size(); ++w) {
      const Wall& wall = building_.walls[w];
      const auto span = overlap_in_line({wall.a, wall.b}, door, config_);
      // The wall over a gap is another door's, unless both are drawn over each other.
      const double least_m = w < first_lintel_ ? config_.least_span_m : config_.least_in_walls * door.length();
      if (span && span->second - span->first >= least_m)
        found.push_back({static_cast<int>(w), span->first, span->second});
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const WallSpan& a, const WallSpan& b) { return a.s1 - a.s0 > b.s1 - b.s0; });
    const Eigen::Vector2d along = (door.b - door.a) / door.length();
    const auto on_door = [&](const WallSpan& span) {
      const Wall& wall = building_.walls[static_cast<std::size_t>(span.wall)];
      return std::minmax<double>({along.dot(wall.a + span.s0 * wall.direction() - door.a),
                                  along.dot(wall.a + span.s1 * wall.direction() - door.a)});
    };
    double width = 0.0;
    for (const WallSpan& span : found) {
      // A second wall along the same part of the door stays closed.
      const auto [from, to] = on_door(span);
      const bool taken = std::any_of(spans.begin(), spans.end(), [&, from = from, to = to](const WallSpan& other) {
        const auto [other_from, other_to] = on_door(other);
        return std::min(to, other_to) - std::max(from, other_from) > 0.5 * (to - from);
      });
      if (taken) continue;
      spans.push_back(span);
      width += span.s1 - span.s0;
    }
    return width < config_.least_in_walls * door.length() ? std::vector<WallSpan>{} : spans;
  }

  /// A wall over the gap whose whole width is open up to the door's head, so that a lintel remains.
  void add_filled_gap(const std::string& id, OpeningKind kind, const Segment& gap) {
    building_.walls.push_back(make_wall(id + "/lintel", gap.a, gap.b));
    const Wall& wall = building_.walls.back();
    add_opening(id, kind, static_cast<int>(building_.walls.size()) - 1, 0.5 * wall.length(), wall.length());
  }

  void add_doorways(const TrafficLevel& level) {
    std::vector<Segment> walls;
    for (std::size_t w = first_wall_; w < building_.walls.size(); ++w)
      walls.push_back({building_.walls[w].a, building_.walls[w].b});
    int number = 0;
    for (const Segment& gap : find_doorways(walls, config_)) {
      const std::string id = level.name + "/doorway" + std::to_string(++number);
      warn(id, "assumed_doorway", "a gap between walls in line is taken as a doorway with a lintel");
      add_filled_gap(id, OpeningKind::opening_void, gap);
    }
  }

  /// Walls that meet at an angle reach half a thickness beyond their common point, or a notch would stay open.
  void close_corners() {
    std::vector<Segment> walls;
    for (std::size_t w = first_wall_; w < building_.walls.size(); ++w)
      walls.push_back({building_.walls[w].a, building_.walls[w].b});
    for (std::size_t i = 0; i < walls.size(); ++i) {
      Wall& wall = building_.walls[first_wall_ + i];
      const bool opened = std::any_of(building_.openings.begin(), building_.openings.end(),
                                      [&](const Opening& o) { return o.wall == static_cast<int>(first_wall_ + i); });
      if (opened) continue;
      const Eigen::Vector2d reach = 0.5 * config_.wall_thickness_m * wall.direction();
      const bool at_a = is_corner(walls, i, walls[i].a, config_), at_b = is_corner(walls, i, walls[i].b, config_);
      if (at_a) wall.a = (wall.a - reach).unaryExpr(&coordinate);
      if (at_b) wall.b = (wall.b + reach).unaryExpr(&coordinate);
    }
  }

  /// Floors as drawn, filled up under the walls, and a ceiling over each.
  void add_slabs(const TrafficLevel& level) {
    std::vector<Polygon2> parts, holes;
    for (const std::vector<std::size_t>& floor : level.floors) {
      parts.push_back(outline(level, floor));
      if (parts.back().size() < 3 || !is_simple(parts.back()))
        warn(level.name, "bad_floor", "the outline of a floor crosses itself or has no area; it is left out");
    }
    for (const std::vector<std::size_t>& hole : level.holes) holes.push_back(outline(level, hole));
    const bool drawn = !parts.empty();
    for (std::size_t w = first_wall_; w < building_.walls.size(); ++w) parts.push_back(footprint(building_.walls[w]));
    Region2 floor = unite(parts);
    if (!drawn) {
      warn(level.name, "assumed_floor", "no floor is drawn; everything within the outer walls gets one");
      std::vector<Polygon2> outlines;
      for (const PolygonWithHoles2& piece : floor) outlines.push_back(piece.outer);
      floor = unite(outlines);
    }
    floor_ = subtract(floor, holes);
    int number = 0;
    const double ceiling_z = storey().elevation_m + storey().height_m;
    for (const PolygonWithHoles2& piece : floor_) {
      const std::string suffix = number++ == 0 ? "" : "-" + std::to_string(number);
      add_slab(level.name + "/floor" + suffix, piece, storey().elevation_m - config_.slab_m);
      add_slab(level.name + "/ceiling" + suffix, piece, ceiling_z);
    }
  }

  void add_slab(std::string id, const PolygonWithHoles2& polygon, double z0_m) {
    Slab slab;
    slab.id = std::move(id);
    slab.storey = storey_;
    slab.polygon = polygon;
    slab.z0_m = z0_m;
    slab.z1_m = z0_m + config_.slab_m;
    building_.slabs.push_back(std::move(slab));
  }

  void add_rooms(const TrafficLevel& level) {
    Building alone;
    alone.storeys = {storey()};
    alone.walls.assign(building_.walls.begin() + static_cast<std::ptrdiff_t>(first_wall_), building_.walls.end());
    std::vector<Room> rooms = infer_rooms(alone, 0);
    // A room may stand within another; the smaller one comes first, so that a point in both belongs to it.
    std::stable_sort(rooms.begin(), rooms.end(),
                     [](const Room& a, const Room& b) { return signed_area(a.polygon) < signed_area(b.polygon); });
    int number = 0;
    for (Room& room : rooms) {
      const Region2 whole = unite(std::vector<Polygon2>{room.polygon});
      if (area(intersect(whole, floor_)) < config_.least_floor * signed_area(room.polygon)) continue;
      room.storey = storey_;
      room.id = level.name + "/room" + std::to_string(++number);
      room.name = name_of(room, level);
      building_.rooms.push_back(std::move(room));
    }
    if (number == 0) warn(level.name, "no_rooms", "walls enclose no room over a floor");
  }

  /// The first named vertex that lies in this room and in none before it; its id without one.
  [[nodiscard]] std::string name_of(const Room& room, const TrafficLevel& level) const {
    for (const TrafficVertex& vertex : level.vertices) {
      const auto holds = [&](const Room& other) {
        return other.storey == storey_ && contains(other.polygon, vertex.p_W);
      };
      const bool taken = std::any_of(building_.rooms.begin(), building_.rooms.end(), holds);
      if (!vertex.name.empty() && !taken && contains(room.polygon, vertex.p_W)) return vertex.name;
    }
    return room.id;
  }

  const TrafficFile& file_;
  const TrafficEditorConfig& config_;
  Building building_;
  int storey_ = 0;
  std::size_t first_wall_ = 0;  ///< of the level at hand
  std::size_t first_lintel_ = 0;
  Region2 floor_;  ///< of the level at hand
};

}  // namespace

Building read_traffic_editor_text(std::string_view text, const std::string& file, const TrafficEditorConfig& config) {
  if (text.size() > config.most_bytes)
    throw InputError({file, 0, 0}, "larger than " + std::to_string(config.most_bytes) + " bytes; that is no plan");
  TrafficFile parsed = read_traffic_file(read_yaml(text, file), config);
  std::vector<Warning> warnings;
  align_levels(parsed, config, warnings);
  Building building = TrafficBuilder(parsed, config).build();
  building.warnings.insert(building.warnings.begin(), warnings.begin(), warnings.end());
  if (building.walls.empty()) throw InputError({file, 0, 0}, "no level has walls; a building needs some");
  return building;
}

}  // namespace plumbline::bim
