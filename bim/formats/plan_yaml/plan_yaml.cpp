// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/plan_yaml/plan_yaml.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "bim/errors.h"
#include "bim/formats/plan_yaml/plan_elements.h"
#include "bim/formats/plan_yaml/plan_file.h"
#include "bim/formats/plan_yaml/plan_stairs.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/model/blocked_doors.h"
#include "bim/model/boxes.h"
#include "bim/model/materials.h"
#include "bim/model/odd_size.h"
#include "bim/model/rooms.h"
#include "bim/model/virtual_edges.h"
#include "bim/model/wall_face.h"

namespace plumbline::bim {

namespace {

/// Turns a checked file into a building, storey by storey; a copied storey gets the entries of its source again.
class PlanBuilder {
 public:
  PlanBuilder(const PlanFile& plan, const Tree& tree, const PlanSolids& solids)
      : plan_(plan), tree_(tree), solids_(solids) {
    for (const PlanOpeningEntry& opening : plan.openings) openings_.emplace(opening.wall, &opening);
  }

  Building build() {
    building_.name = plan_.name;
    building_.schema = "plan";
    building_.unit = "m";
    for (const PlanMaterialEntry& material : plan_.materials) add_material(material);
    for (std::size_t i = 0; i < plan_.storeys.size(); ++i) add_storey(static_cast<int>(i));
    find_room_walls(building_);
    find_opening_rooms(building_);
    find_virtual_edges(building_);
    find_stair_rooms(building_);
    check_rooms();
    add_stairs(plan_, tree_, building_);
    warn_of_blocked_doors(building_);
    if (const std::string odd = odd_size(building_); !odd.empty())
      building_.warnings.push_back({"", "odd_size", odd + " Lengths of a plan are in metres"});
    return std::move(building_);
  }

 private:
  /// Where the entries of the storey at hand come from and how high it is.
  struct Level : PlanLevel {
    std::string source;  ///< storey id the entries name
    double ceiling_z0 = 3.0, ceiling_z1 = 3.2;
    std::size_t first_wall = 0;
  };

  void add_material(const PlanMaterialEntry& material) {
    building_.materials.push_back(material);
    if (material.transmission >= see_through_share)
      building_.warnings.push_back(
          {material.id, "see_through", "transparent to the LiDAR, except at normal incidence"});
  }

  Level level_of(int index) const {
    const PlanStoreyEntry& storey = plan_.storeys[static_cast<std::size_t>(index)];
    Level level;
    level.index = index;
    level.source = storey.copy_of.empty() ? storey.id : storey.copy_of;
    level.prefix = storey.copy_of.empty() ? "" : storey.id + "/";
    level.floor_z_m = storey.elevation_m;
    level.top_z_m = storey.elevation_m + storey_height(plan_, storey);
    level.ceiling_z1 = level.top_z_m + solids_.slab_m;
    // Under a further storey the ceiling is the slab that storey stands on.
    for (const PlanStoreyEntry& other : plan_.storeys)
      if (other.elevation_m > storey.elevation_m) level.ceiling_z1 = std::min(level.ceiling_z1, other.elevation_m);
    level.ceiling_z0 = level.ceiling_z1 - solids_.slab_m;
    level.first_wall = building_.walls.size();
    return level;
  }

  void add_storey(int index) {
    const PlanStoreyEntry& entry = plan_.storeys[static_cast<std::size_t>(index)];
    building_.storeys.push_back({entry.id, entry.id, entry.elevation_m, storey_height(plan_, entry)});
    const Level level = level_of(index);
    // A copy's own entries follow those it repeats.
    add_entries(level);
    if (!level.prefix.empty()) {
      Level own = level;
      own.source = entry.id;
      own.prefix.clear();
      add_entries(own);
    }
    add_rooms(level);
    add_slabs(level);
  }

  void add_entries(const Level& level) {
    const std::size_t first_wall = building_.walls.size();
    for (const PlanWallEntry& wall : plan_.walls)
      if (wall.storey == level.source) add_wall(wall, level);
    for (std::size_t w = first_wall; w < building_.walls.size(); ++w) {
      const auto [first, last] = openings_.equal_range(building_.walls[w].id.substr(level.prefix.size()));
      for (auto opening = first; opening != last; ++opening) add_opening(*opening->second, static_cast<int>(w), level);
    }
    for (const PlanColumnEntry& column : plan_.columns)
      if (column.storey == level.source) add_column(column, level);
    for (const PlanClutterEntry& clutter : plan_.clutter)
      if (clutter.storey == level.source) add_clutter(clutter, level);
  }

  void add_wall(const PlanWallEntry& entry, const Level& level) {
    use_material(building_, entry.material);
    building_.walls.push_back(wall_of(entry, level));
  }

  void add_opening(const PlanOpeningEntry& entry, int wall, const Level& level) {
    use_material(building_, entry.material);
    building_.openings.push_back(
        opening_of(entry, level.prefix, wall, building_.walls[static_cast<std::size_t>(wall)]));
  }

  void add_column(const PlanColumnEntry& entry, const Level& level) {
    use_material(building_, entry.material);
    building_.columns.push_back(column_of(entry, level));
  }

  void add_clutter(const PlanClutterEntry& entry, const Level& level) {
    use_material(building_, entry.material);
    building_.obstacles.push_back(clutter_of(entry, level, solids_.cylinder_sides));
  }

  void add_rooms(const Level& level) {
    const BoxIndex walls = boxes_of(building_.walls, level.first_wall);
    for (std::size_t i = 0; i < plan_.rooms.size(); ++i) {
      const std::string& storey = plan_.rooms[i].storey;
      if (storey == level.source) add_room(i, level.prefix, level, walls);
      if (!level.prefix.empty() && storey + "/" == level.prefix) add_room(i, "", level, walls);
    }
  }

  void add_room(std::size_t entry_index, const std::string& prefix, const Level& level, const BoxIndex& boxes) {
    const PlanRoomEntry& entry = plan_.rooms[entry_index];
    std::vector<Wall> walls;
    for (const int i : boxes.near(entry.polygon, 0.0))
      walls.push_back(building_.walls[level.first_wall + static_cast<std::size_t>(i)]);
    const std::vector<Polygon2> outlines = clear_outlines(entry.polygon, walls);
    if (outlines.empty())
      throw InputError(place_of_room(entry_index),
                       "the polygon of room '" + entry.id + "' lies inside walls; draw it around free space");
    if (outlines.size() > 1 && signed_area(outlines[1]) > solids_.room_remnant_m2)
      throw InputError(place_of_room(entry_index),
                       "a wall divides room '" + entry.id + "'; draw a polygon on each side of it");
    Room room;
    room.id = prefix + entry.id;
    room.name = room.id;
    room.storey = level.index;
    room.polygon = outlines.front();
    room.z0_m = level.floor_z_m;
    room.z1_m = std::min(level.top_z_m, level.ceiling_z0);
    for (const std::string& wall : entry.walls) room.walls.push_back(wall_index(prefix + wall));
    std::sort(room.walls.begin(), room.walls.end());
    room.walls.erase(std::unique(room.walls.begin(), room.walls.end()), room.walls.end());
    building_.rooms.push_back(std::move(room));
    room_entries_.push_back(entry_index);
  }

  int wall_index(const std::string& id) const {
    const auto found =
        std::find_if(building_.walls.begin(), building_.walls.end(), [&](const Wall& wall) { return wall.id == id; });
    if (found == building_.walls.end()) throw InternalError("a room names a wall that was not built");
    return static_cast<int>(found - building_.walls.begin());
  }

  /// Floor and ceiling over everything within the outermost walls and room outlines.
  void add_slabs(const Level& level) {
    std::vector<Polygon2> parts;
    for (std::size_t w = level.first_wall; w < building_.walls.size(); ++w)
      parts.push_back(footprint(building_.walls[w]));
    const std::string& storey = plan_.storeys[static_cast<std::size_t>(level.index)].id;
    for (const PlanRoomEntry& room : plan_.rooms)
      if (room.storey == level.source || room.storey == storey) parts.push_back(room.polygon);
    std::vector<Polygon2> outlines;
    for (const PolygonWithHoles2& piece : unite(parts)) outlines.push_back(piece.outer);
    int number = 0;
    for (const PolygonWithHoles2& piece : unite(outlines)) {
      const std::string suffix = number++ == 0 ? "" : "-" + std::to_string(number);
      add_slab(storey + "/floor" + suffix, piece, level.index, level.floor_z_m - solids_.slab_m, level.floor_z_m);
      building_.slabs.back().material = plan_.storeys[static_cast<std::size_t>(level.index)].floor_material;
      use_material(building_, building_.slabs.back().material);
      add_slab(storey + "/ceiling" + suffix, piece, level.index, level.ceiling_z0, level.ceiling_z1);
    }
  }

  void add_slab(std::string id, const PolygonWithHoles2& polygon, int storey, double z0, double z1) {
    Slab slab;
    slab.id = std::move(id);
    slab.storey = storey;
    slab.polygon = polygon;
    slab.z0_m = z0;
    slab.z1_m = z1;
    building_.slabs.push_back(std::move(slab));
  }

  void check_rooms() const {
    std::vector<Eigen::AlignedBox2d> boxes(building_.rooms.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
      for (const Eigen::Vector2d& p : building_.rooms[i].polygon) boxes[i].extend(p);
    for (std::size_t i = 0; i < building_.rooms.size(); ++i) {
      const Room& room = building_.rooms[i];
      if (room.walls.empty())
        throw InputError(place_of_room(room_entries_[i]), "no wall runs along the outline of room '" + room.id +
                                                              "'; draw its polygon along walls or name its walls");
      for (std::size_t j = 0; j < i; ++j) {
        const Room& other = building_.rooms[j];
        if (other.storey != room.storey || !boxes[i].intersects(boxes[j])) continue;
        if (intersection_area(room.polygon, other.polygon) <= solids_.room_overlap_m2) continue;
        throw InputError(place_of_room(room_entries_[i]), "room '" + room.id + "' overlaps room '" + other.id +
                                                              "'; rooms of a storey must lie beside each other");
      }
    }
  }

  Mark place_of_room(std::size_t entry_index) const {
    return tree_.find("rooms")->as_list().at(entry_index).find("polygon")->mark;
  }

  const PlanFile& plan_;
  const Tree& tree_;
  const PlanSolids& solids_;
  std::multimap<std::string, const PlanOpeningEntry*> openings_;  ///< by wall, those of one wall as listed
  Building building_;
  std::vector<std::size_t> room_entries_;  ///< entry each room came from
};

bool is_scenario(const Tree& tree) {
  return tree.is_map() && !tree.as_map().empty() && tree.as_map().front().first == "scenario";
}

/// ", FILE", where a scenario says it.
std::string building_of(const Tree& scenario) {
  const Tree* building = scenario.find("building");
  return building != nullptr && std::holds_alternative<std::string>(building->value) ? ", " + building->as_string()
                                                                                     : "";
}

}  // namespace

PlanFile plan_entries(const Tree& tree) {
  if (!tree.is_map() || tree.as_map().empty() || tree.as_map().front().first != "plan")
    throw InputError(tree.mark, is_scenario(tree)
                                    ? "this is a scenario, not a plan; name its building" + building_of(tree)
                                    : "not a plan file; the first key must be 'plan: 1'");
  PlanFile plan = from_tree<PlanFile>(tree);
  check_plan(plan, tree);
  return plan;
}

Building read_plan_text(std::string_view text, const std::string& file, const PlanSolids& solids) {
  return read_plan_with_deviations(text, file, solids).as_planned;
}

PlanWithDeviations read_plan_with_deviations(std::string_view text, const std::string& file, const PlanSolids& solids) {
  const Tree tree = read_yaml(text, file);
  const PlanFile plan = plan_entries(tree);
  PlanWithDeviations both;
  both.as_planned = PlanBuilder(plan, tree, solids).build();
  const Tree* deviations = tree.find("deviations");
  both.as_built = apply_deviations(both.as_planned, plan.deviations, deviations != nullptr ? *deviations : tree);
  return both;
}

}  // namespace plumbline::bim
