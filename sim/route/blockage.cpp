// SPDX-License-Identifier: Apache-2.0
#include "sim/route/blockage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "bim/config/tree.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/model/steep_floors.h"
#include "bim/model/through.h"
#include "sim/route/clearance_map.h"
#include "sim/route/grid_search.h"
#include "sim/route/obstacle_footprint.h"

namespace plumbline::sim {

namespace {

/// What a tenth of a cell on the way costs: what is cleared more easily comes first, unless it is much longer.
constexpr std::int64_t free_cost = 1;
constexpr std::int64_t narrow_cost = 30;      // and so much more where nothing is clear
constexpr std::int64_t opening_cost = 300;    // a door that is closed, a window
constexpr std::int64_t furniture_cost = 500;  // and columns, stairs, slabs
constexpr std::int64_t no_floor_cost = 100;
constexpr std::int64_t wall_cost = 20000;  // metres of missing floor are cleared before a wall is

std::string metres(double x) { return format_number(std::round(x * 1e2) / 1e2) + " m"; }

std::string place(const Eigen::Vector2d& p) {
  return "[" + format_number(std::round(p.x() * 1e2) / 1e2) + ", " + format_number(std::round(p.y() * 1e2) / 1e2) + "]";
}

std::string_view kind_of(const bim::Opening& opening) {
  if (opening.kind == bim::OpeningKind::window) return "window";
  return opening.kind == bim::OpeningKind::door ? "door" : "opening";
}

BlockageKind kind_of(const std::string& name) {
  for (const char* built : {"wall", "slab", "column", "stair", "door", "window", "opening", "step", "ramp", "the edge"})
    if (name.rfind(built, 0) == 0) return BlockageKind::structure;
  return BlockageKind::furniture;
}

double distance(const ObstacleFootprint& footprint, const Eigen::Vector2d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Segment2& edge : footprint.edges) least = std::min(least, segment_distance(edge.a, edge.b, p));
  return least;
}

}  // namespace

struct Blockages::Impl {
  Impl(const bim::Building& building_in, int storey_in, const ClearanceMap& space_in, const Eigen::Vector2d& start_W)
      : building(building_in),
        storey(storey_in),
        floor_z(space_in.ground_W()),
        space(space_in),
        footprints(find_obstacle_footprints(building, floor_z, space.config())),
        steep(bim::steep_floors(building, storey, floor_z)),
        opening(space.grid().size(), -1),
        solid(space.grid().size(), -1),
        cost(space.grid().size(), std::numeric_limits<std::int32_t>::max()),
        before(space.grid().size(), 0) {
    for (std::size_t i = 0; i < footprints.size(); ++i)
      for (const std::vector<Segment2>& section : footprints[i].sections)
        fill_cells(space.grid(), section, [&](std::size_t cell) { mark_solid(cell, i); });
    for (std::size_t i = 0; i < building.walls.size(); ++i) mark_wall(i);
    for (std::size_t i = 0; i < building.openings.size(); ++i) mark_opening(i);
    search(start_W);
  }

  /// A wall's gaps stay what they are; of other things in them the first counts.
  void mark_solid(std::size_t cell, std::size_t footprint) {
    const Eigen::Vector2d p = space.grid().center(cell);
    const std::vector<Gap>& gaps = footprints[footprint].gaps;
    if (solid[cell] >= 0 || std::any_of(gaps.begin(), gaps.end(), [&](const Gap& gap) { return gap.holds(p); })) return;
    solid[cell] = static_cast<std::int32_t>(footprint);
  }

  /// A wall whose surface does not close is solid all the same.
  void mark_wall(std::size_t index) {
    const bim::Wall& wall = building.walls[index];
    const std::string name = "wall '" + wall.id + "'";
    const auto own = std::find_if(footprints.begin(), footprints.end(),
                                  [&](const ObstacleFootprint& footprint) { return footprint.name == name; });
    if (own == footprints.end()) return;
    const Eigen::Vector2d low = wall.offset_m * wall.left(), high = (wall.offset_m + wall.thickness_m) * wall.left();
    fill_cells(space.grid(), outline({wall.a + low, wall.b + low, wall.b + high, wall.a + high}),
               [&](std::size_t cell) { mark_solid(cell, static_cast<std::size_t>(own - footprints.begin())); });
  }

  [[nodiscard]] static std::vector<Segment2> outline(const Polygon2& corners) {
    std::vector<Segment2> segments;
    for (std::size_t i = 0; i < corners.size(); ++i)
      segments.push_back({corners[i], corners[(i + 1) % corners.size()]});
    return segments;
  }

  [[nodiscard]] bool in_wall(std::size_t cell) const {
    return solid[cell] >= 0 && footprints[static_cast<std::size_t>(solid[cell])].name.rfind("wall", 0) == 0;
  }

  /// Also what lies a little before its wall, where nothing else is.
  void mark_opening(std::size_t index) {
    const bim::Opening& o = building.openings[index];
    if (o.wall < 0 || o.z0_m > floor_z + high_sill_m || o.z1_m < floor_z) return;
    const bim::Wall& wall = building.walls[static_cast<std::size_t>(o.wall)];
    if (!bim::goes_through(o, wall)) return;
    const Eigen::Vector2d e = wall.direction(), left = wall.left();
    const double along = 0.5 * o.width_m, reach = 0.5 * space.grid().cell;
    const Eigen::Vector2d low = (wall.offset_m - reach) * left;
    const Eigen::Vector2d high = (wall.offset_m + wall.thickness_m + reach) * left;
    const Eigen::Vector2d from = wall.a + (o.s_m - along) * e, to = wall.a + (o.s_m + along) * e;
    fill_cells(space.grid(), outline({from + low, to + low, to + high, from + high}),
               [&](std::size_t cell) { opening[cell] = static_cast<std::int32_t>(index); });
  }

  [[nodiscard]] std::int64_t cost_of(std::size_t cell) const {
    if (space.passable(cell)) return free_cost;
    const double clearance = space.cell_clearance(cell);
    if (opening[cell] >= 0 && !(clearance > 0.0)) return opening_cost;
    if (opening[cell] < 0 && in_wall(cell)) return wall_cost;
    if (clearance > 0.0)
      return narrow_cost + static_cast<std::int64_t>(narrow_cost * (1.0 - clearance / space.config().radius_m));
    if (!space.has_floor(cell)) return no_floor_cost;
    return furniture_cost;
  }

  void search(const Eigen::Vector2d& start_W) {
    const auto start = space.grid().find(start_W);
    if (!start) return;
    BucketQueue open(diagonal_step * wall_cost);
    cost[*start] = 0;
    before[*start] = static_cast<std::uint32_t>(*start);
    open.push(0, *start);
    while (!open.empty()) {
      const auto [reached, cell] = open.pop();
      if (reached != cost[cell]) continue;
      const auto [column, row] = space.grid().column_and_row(cell);
      for (const GridStep& step : grid_steps) {
        if (!space.grid().holds(column + step.dx, row + step.dy)) continue;
        const std::size_t next = space.grid().index(column + step.dx, row + step.dy);
        const std::int64_t there = reached + step.length * cost_of(next);
        if (there >= cost[next]) continue;
        cost[next] = static_cast<std::int32_t>(there);
        before[next] = static_cast<std::uint32_t>(cell);
        open.push(there, next);
      }
    }
  }

  /// Stretches of the way back to the start that the robot cannot walk, from the start on.
  [[nodiscard]] std::vector<std::vector<std::size_t>> stretches(std::size_t goal) const {
    std::vector<std::vector<std::size_t>> found;
    bool inside = false;
    for (std::size_t cell = goal;; cell = before[cell]) {
      const bool blocked = !space.passable(cell) || (before[cell] != cell && !space.joined(cell, before[cell]));
      if (blocked && !inside) found.emplace_back();
      if (blocked) found.back().push_back(cell);
      inside = blocked;
      if (before[cell] == cell) break;
    }
    std::reverse(found.begin(), found.end());
    for (std::vector<std::size_t>& stretch : found) std::reverse(stretch.begin(), stretch.end());
    return found;
  }

  /// The highest step of a stretch, where nothing but the floor is in the way.
  [[nodiscard]] std::optional<Blockage> too_high(const std::vector<std::size_t>& stretch) const {
    double highest = 0.0;
    std::size_t at = stretch.front();
    for (const std::size_t cell : stretch) {
      if (!(space.cell_clearance(cell) > 0.0) || (opening[cell] < 0 && in_wall(cell))) return std::nullopt;
      const double rise = std::abs(space.cell_height(cell) - space.cell_height(before[cell]));
      if (!space.is_step(cell, before[cell]) || rise <= highest) continue;
      highest = rise;
      at = cell;
    }
    if (!(highest > 0.0)) return std::nullopt;
    const Eigen::Vector2d p = space.grid().center(at);
    const std::string step = "a step of " + metres(highest) + " near " + place(p);
    if (highest > space.config().climb_m + 1e-3)
      return Blockage{BlockageKind::structure, "step",
                      step + " is higher than the " + metres(space.config().climb_m) + " that the robot climbs", p};
    return Blockage{
        BlockageKind::structure, "step",
        step + " has less than " + metres(space.config().step_before_min_m) + " of free floor before or behind it", p};
  }

  /// The sloping floor that a stretch leads over, where neither a wall nor a shut door is in the way.
  [[nodiscard]] std::optional<Blockage> too_steep(const std::vector<std::size_t>& stretch) const {
    const auto is_shut_off = [&](std::size_t cell) { return opening[cell] < 0 ? in_wall(cell) : is_shut(cell); };
    if (std::any_of(stretch.begin(), stretch.end(), is_shut_off)) return std::nullopt;
    for (const std::size_t cell : stretch)
      for (const bim::SteepFloor& floor : steep)
        if (const Eigen::Vector2d p = space.grid().center(cell); contains(floor.polygon, p))
          return Blockage{BlockageKind::structure, floor.name, bim::too_steep_text(floor), p};
    return std::nullopt;
  }

  /// Everything in a stretch of the way that has to be cleared, each thing once.
  [[nodiscard]] std::vector<Blockage> describe(const std::vector<std::size_t>& stretch) const {
    if (std::optional<Blockage> slope = too_steep(stretch)) return {*slope};
    std::vector<Blockage> found;
    std::set<std::pair<int, std::int32_t>> named;
    std::size_t floorless = 0;
    for (std::size_t i = 0; i <= stretch.size(); ++i) {
      const bool edge = i < stretch.size() && !is_obstructed(stretch[i]) && is_at_edge(stretch[i]);
      if (!edge && floorless >= least_gap) found.push_back(edge_of_floor({stretch.data() + i - floorless, floorless}));
      floorless = edge ? floorless + 1 : 0;
      if (i == stretch.size() || edge || !is_obstructed(stretch[i])) continue;
      const std::size_t cell = stretch[i];
      if (!named.emplace(opening[cell] >= 0 ? 0 : 1, opening[cell] >= 0 ? opening[cell] : solid[cell]).second) continue;
      if (opening[cell] < 0)
        found.push_back(solid_or_edge(cell));
      else
        found.push_back(is_shut(cell) ? in_opening(cell) : narrow_opening(cell));
    }
    if (!found.empty()) return found;
    if (std::optional<Blockage> step = too_high(stretch)) return {*step};
    const auto narrowest = std::min_element(stretch.begin(), stretch.end(), [&](std::size_t a, std::size_t b) {
      return space.cell_clearance(a) < space.cell_clearance(b);
    });
    if (!(space.cell_clearance(*narrowest) > 0.0)) return {solid_or_edge(*worst(stretch))};
    return {opening[*narrowest] >= 0 ? narrow_opening(*narrowest) : gap(*narrowest)};
  }

  /// Without a floor, or where the end of the floor is what leaves too little room, whatever is on the other side.
  [[nodiscard]] bool is_at_edge(std::size_t cell) const {
    if (!space.has_floor(cell)) return true;
    if (space.passable(cell)) return false;
    const double cell_m = space.grid().cell,
                 within = space.cell_clearance(cell) + 0.75 * cell_m;  // half a diagonal of a cell
    const auto reach = static_cast<int>(within / cell_m);
    const auto [column, row] = space.grid().column_and_row(cell);
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx) {
        if (!space.grid().holds(column + dx, row + dy) || cell_m * std::hypot(dx, dy) > within) continue;
        const std::size_t near = space.grid().index(column + dx, row + dy);
        if (solid[near] < 0 && opening[near] < 0 && !space.has_floor(near)) return true;
      }
    return false;
  }

  /// In an opening that is no way for the robot, or in a wall or another solid thing.
  [[nodiscard]] bool is_obstructed(std::size_t cell) const {
    if (opening[cell] < 0) return solid[cell] >= 0 && (in_wall(cell) || !(space.cell_clearance(cell) > 0.0));
    const bim::Opening& o = building.openings[static_cast<std::size_t>(opening[cell])];
    return is_shut(cell) || o.width_m < 2.0 * space.config().radius_m;
  }

  [[nodiscard]] bool is_shut(std::size_t cell) const {
    if (space.cell_clearance(cell) > 0.0) return false;
    const bim::Opening& o = building.openings[static_cast<std::size_t>(opening[cell])];
    return o.kind == bim::OpeningKind::window || solid[cell] >= 0 ||
           (o.kind == bim::OpeningKind::door && o.leaf == bim::Leaf::closed);
  }

  /// Of cells at the edge, in the order of the way.
  [[nodiscard]] Blockage edge_of_floor(std::span<const std::size_t> cells) const {
    if (std::any_of(cells.begin(), cells.end(), [&](std::size_t cell) { return !space.has_floor(cell); }))
      return end_of_floor(cells[(cells.size() - 1) / 2]);
    const std::size_t narrowest = *std::min_element(cells.begin(), cells.end(), [&](std::size_t a, std::size_t b) {
      return space.cell_clearance(a) < space.cell_clearance(b);
    });
    const Eigen::Vector2d p = space.grid().center(narrowest);
    const std::string beside = nearest(p, 1).front();
    return {kind_of(beside), "",
            "between " + beside + " and the edge of the floor near " + place(p) + " are " + free_and_needed(narrowest),
            p};
  }

  [[nodiscard]] Blockage end_of_floor(std::size_t cell) const {
    const Eigen::Vector2d p = space.grid().center(cell);
    return {BlockageKind::structure, "", "there is no floor near " + place(p), p};
  }

  [[nodiscard]] std::vector<std::size_t>::const_iterator worst(const std::vector<std::size_t>& stretch) const {
    return std::max_element(stretch.begin(), stretch.end(),
                            [&](std::size_t a, std::size_t b) { return cost_of(a) < cost_of(b); });
  }

  /// Why a doorway in which nothing is clear cannot be walked through.
  [[nodiscard]] Blockage in_opening(std::size_t cell) const {
    const bim::Opening& o = building.openings[static_cast<std::size_t>(opening[cell])];
    const RouteConfig& config = space.config();
    const std::string name = std::string(kind_of(o)) + " '" + o.id + "'";
    const Eigen::Vector2d p = space.grid().center(cell);
    if (o.kind == bim::OpeningKind::door && o.leaf == bim::Leaf::closed)
      return {BlockageKind::closed_door, name, name + " is closed", p};
    BlockageKind kind = BlockageKind::structure;
    std::string text = name + " is a window";
    if (o.z0_m > floor_z + config.sill_max_m)
      text = name + " begins " + metres(o.z0_m - floor_z) + " above the floor, and the robot steps over " +
             metres(config.sill_max_m);
    else if (o.z1_m < floor_z + config.head_min_m)
      text = name + " ends " + metres(o.z1_m - floor_z) + " above the floor, and the robot needs " +
             metres(config.head_min_m);
    else if (o.kind != bim::OpeningKind::window && solid[cell] >= 0) {
      const std::string& filling = footprints[static_cast<std::size_t>(solid[cell])].name;
      text = filling + " stands in " + name;
      kind = kind_of(filling);
    } else if (o.kind != bim::OpeningKind::window)
      text = "there is no floor in " + name;
    return {kind, name, text, p};
  }

  [[nodiscard]] std::string free_and_needed(std::size_t cell) const {
    return metres(2.0 * space.cell_clearance(cell)) + " free, and the robot needs " +
           metres(2.0 * space.config().radius_m);
  }

  [[nodiscard]] Blockage narrow_opening(std::size_t cell) const {
    const bim::Opening& o = building.openings[static_cast<std::size_t>(opening[cell])];
    const std::string name = std::string(kind_of(o)) + " '" + o.id + "'";
    const Eigen::Vector2d p = space.grid().center(cell);
    const double needed = 2.0 * space.config().radius_m;
    if (o.width_m < needed)
      return {BlockageKind::structure, name,
              name + " is " + metres(o.width_m) + " wide, and the robot needs " + metres(needed), p};
    const std::string own = "wall '" + building.walls[static_cast<std::size_t>(o.wall)].id + "'";
    // The door is wide enough: its own wall is beside the way, and what else is near is in it.
    const std::vector<std::string> around = nearest(p, 3, needed);
    const auto other = std::find_if(around.begin(), around.end(), [&](const std::string& it) { return it != own; });
    const std::string& near = other == around.end() ? around.front() : *other;
    return {kind_of(near), name, name + " leaves " + free_and_needed(cell) + " (" + near + " is in the way)", p};
  }

  /// Names of the nearest obstacles, by distance (ties: the one listed first); after the first none beyond `within_m`.
  [[nodiscard]] std::vector<std::string> nearest(const Eigen::Vector2d& p, std::size_t count,
                                                 double within_m = std::numeric_limits<double>::infinity()) const {
    std::vector<std::pair<double, std::size_t>> by_distance;
    for (std::size_t i = 0; i < footprints.size(); ++i) by_distance.emplace_back(distance(footprints[i], p), i);
    std::sort(by_distance.begin(), by_distance.end());
    std::vector<std::string> names;
    for (const auto& [distance_m, i] : by_distance)
      if (names.empty() || (names.size() < count && distance_m <= within_m)) names.push_back(footprints[i].name);
    if (names.empty()) names.emplace_back("the edge of the floor");
    return names;
  }

  [[nodiscard]] Blockage gap(std::size_t cell) const {
    const Eigen::Vector2d p = space.grid().center(cell);
    std::vector<std::string> names = nearest(p, 2);
    if (names.size() < 2) names.emplace_back("the edge of the floor");
    const bool moves = kind_of(names[0]) == BlockageKind::furniture || kind_of(names[1]) == BlockageKind::furniture;
    return {moves ? BlockageKind::furniture : BlockageKind::structure, names[0],
            "between " + names[0] + " and " + names[1] + " near " + place(p) + " are " + free_and_needed(cell), p};
  }

  [[nodiscard]] Blockage solid_or_edge(std::size_t cell) const {
    const Eigen::Vector2d p = space.grid().center(cell);
    if (solid[cell] >= 0) {
      const std::string& name = footprints[static_cast<std::size_t>(solid[cell])].name;
      const bool is_wall = name.rfind("wall", 0) == 0;
      return {kind_of(name), name, name + (is_wall ? " has no door near " : " stands in the way near ") + place(p), p};
    }
    if (!space.has_floor(cell)) return end_of_floor(cell);
    const std::string name = nearest(p, 1).front();
    return {kind_of(name), name, name + " stands in the way near " + place(p), p};
  }

  static constexpr std::size_t least_gap = 4;  ///< cells without a floor in a row that count
  static constexpr double high_sill_m = 1.2;   ///< what begins higher is no way for a robot by any name
  const bim::Building& building;
  int storey;
  double floor_z;
  const ClearanceMap& space;
  std::vector<ObstacleFootprint> footprints;
  std::vector<bim::SteepFloor> steep;
  std::vector<std::int32_t> opening;  ///< index by cell, -1 for none
  std::vector<std::int32_t> solid;    ///< footprint by cell, -1 for none
  std::vector<std::int32_t> cost;
  std::vector<std::uint32_t> before;
};

Blockages::Blockages(const bim::Building& as_built, int storey, const ClearanceMap& space,
                     const Eigen::Vector2d& start_W)
    : impl_(std::make_unique<Impl>(as_built, storey, space, start_W)) {}

Blockages::~Blockages() = default;

std::vector<Blockage> Blockages::before(const Eigen::Vector2d& goal_W) const {
  std::vector<Blockage> found;
  const auto goal = impl_->space.grid().find(goal_W);
  if (!goal || impl_->cost[*goal] == std::numeric_limits<std::int32_t>::max()) return found;
  for (const std::vector<std::size_t>& stretch : impl_->stretches(*goal)) {
    for (Blockage& blockage : impl_->describe(stretch))
      if (std::none_of(found.begin(), found.end(), [&](const Blockage& other) { return other.text == blockage.text; }))
        found.push_back(std::move(blockage));
  }
  return found;
}

}  // namespace plumbline::sim
