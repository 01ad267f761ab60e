// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/plan_yaml/deviations.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "bim/errors.h"
#include "bim/formats/plan_yaml/as_built_rooms.h"
#include "bim/formats/plan_yaml/message_text.h"
#include "bim/formats/plan_yaml/plan_elements.h"
#include "bim/formats/plan_yaml/plan_file.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/model/materials.h"

namespace plumbline::bim {

namespace {

constexpr double touching_m = 1e-6;  ///< openings may touch each other and the edges of their wall

void shift(std::optional<Solid>& solid, const Eigen::Vector3d& by) {
  if (!solid) return;
  for (Eigen::Vector3d& p : solid->vertices) p += by;
}

void shift(Opening& opening, const Eigen::Vector3d& by) {
  shift(opening.solid, by);
  for (Solid& part : opening.parts)
    for (Eigen::Vector3d& p : part.vertices) p += by;
}

bool overlap(const Opening& a, const Opening& b) {
  const double along = 0.5 * (a.width_m + b.width_m) - std::abs(a.s_m - b.s_m);
  const double up = std::min(a.z1_m, b.z1_m) - std::max(a.z0_m, b.z0_m);
  return a.wall == b.wall && along > touching_m && up > touching_m;
}

/// Applies deviations one after the other.
class Rework {
 public:
  Rework(const Building& as_planned, const Tree& list)
      : as_planned_(as_planned), list_(list), result_{as_planned, {}} {}

  void apply(const PlanDeviationEntry& entry, std::size_t number) {
    number_ = number;
    switch (entry.op) {
      case DeviationOp::move_wall:
        return move_wall(entry);
      case DeviationOp::remove_wall:
        return remove_wall(entry);
      case DeviationOp::tilt_wall:
        return tilt_wall(entry);
      case DeviationOp::add_wall:
        return add_wall(entry.wall);
      case DeviationOp::move_opening:
        return move_opening(entry);
      case DeviationOp::remove_opening:
        return remove_opening(entry);
      case DeviationOp::add_opening:
        return add_opening(entry.opening);
      case DeviationOp::add_clutter:
        return add_clutter(entry.clutter);
      case DeviationOp::add_column:
        return add_column(entry.column);
    }
  }

  AsBuilt finish() {
    if (result_.building.walls.empty())
      throw InputError(list_.mark, "the deviations remove every wall; at least one must stand");
    rebuild_rooms(as_planned_, storeys_, result_.building, result_.changes);
    return std::move(result_);
  }

 private:
  [[nodiscard]] Mark entry_mark() const { return list_.as_list().at(number_).mark; }
  [[nodiscard]] Mark at(std::string_view key) const {
    const Tree* value = list_.as_list().at(number_).find(key);
    return value != nullptr ? value->mark : entry_mark();
  }
  void note(DeviationOp op, const std::string& element) {
    result_.changes.push_back({std::string(EnumNames<DeviationOp>::names[static_cast<std::size_t>(op)]), element});
  }

  /// Index of the element with this id, or InputError with the closest known one.
  template <class Element>
  [[nodiscard]] std::size_t find(const std::vector<Element>& elements, const std::string& id, const std::string& kind,
                                 std::string_view key) const {
    std::vector<std::string> known;
    for (std::size_t i = 0; i < elements.size(); ++i) {
      if (elements[i].id == id) return i;
      known.push_back(elements[i].id);
    }
    const std::string close = did_you_mean(id, known);
    throw InputError(at(key),
                     "there is no " + kind + " " + in_quotes(id) + " at this point" +
                         (close.empty() ? "; name one that stands" : "; did you mean " + in_quotes(close) + "?"));
  }

  void check_new_id(const std::string& id) const {
    check_plan_id(id, at("id"));
    const auto taken = [&](const auto& elements) {
      return std::any_of(elements.begin(), elements.end(), [&](const auto& element) { return element.id == id; });
    };
    for (const Building* building : {&as_planned_, &result_.building})
      if (taken(building->walls) || taken(building->openings) || taken(building->columns) ||
          taken(building->obstacles) || taken(building->stairs))
        throw InputError(at("id"), "the id " + in_quotes(id) + " is taken; ids must be unique");
  }

  void check_material(const std::string& material) {
    if (material.empty()) return;
    check_material_id(result_.building, material, at("material"));
    use_material(result_.building, material);
  }

  [[nodiscard]] PlanLevel level_of(const std::string& storey) const {
    const std::size_t index = find(result_.building.storeys, storey, "storey", "storey");
    const Storey& found = result_.building.storeys[index];
    return {static_cast<int>(index), "", found.elevation_m, found.elevation_m + found.height_m};
  }

  [[nodiscard]] Wall& wall(const PlanDeviationEntry& entry) {
    return result_.building.walls[find(result_.building.walls, entry.target, "wall", "wall")];
  }
  [[nodiscard]] std::vector<Opening*> openings_of(const Wall& wall) {
    const auto index = static_cast<int>(&wall - result_.building.walls.data());
    std::vector<Opening*> openings;
    for (Opening& opening : result_.building.openings)
      if (opening.wall == index) openings.push_back(&opening);
    return openings;
  }

  void move_wall(const PlanDeviationEntry& entry) {
    Wall& moved = wall(entry);
    moved.a += entry.by;
    moved.b += entry.by;
    if (std::max(moved.a.cwiseAbs().maxCoeff(), moved.b.cwiseAbs().maxCoeff()) > plan_reach_m)
      throw InputError(at("by"), "wall " + in_quotes(moved.id) + " would stand more than " + metres(plan_reach_m) +
                                     " from the origin; move it less");
    const Eigen::Vector3d by(entry.by.x(), entry.by.y(), 0.0);
    shift(moved.body, by);
    for (Opening* opening : openings_of(moved)) shift(*opening, by);
    storeys_.insert(moved.storey);
    note(entry.op, moved.id);
  }

  void remove_wall(const PlanDeviationEntry& entry) {
    const Wall removed = wall(entry);
    const auto index = static_cast<int>(find(result_.building.walls, removed.id, "wall", "wall"));
    note(entry.op, removed.id);
    for (const Opening* opening : openings_of(result_.building.walls[static_cast<std::size_t>(index)]))
      note(DeviationOp::remove_opening, opening->id);
    Building& building = result_.building;
    building.walls.erase(building.walls.begin() + index);
    std::erase_if(building.openings, [&](const Opening& opening) { return opening.wall == index; });
    for (Opening& opening : building.openings) opening.wall -= opening.wall > index ? 1 : 0;
    for (Room& room : building.rooms) {
      std::erase(room.walls, index);
      for (int& other : room.walls) other -= other > index ? 1 : 0;
    }
    storeys_.insert(removed.storey);
  }

  void tilt_wall(const PlanDeviationEntry& entry) {
    Wall& tilted = wall(entry);
    const double slope = std::tan(entry.deg * std::numbers::pi / 180.0);
    const Eigen::Vector2d left = tilted.left();
    const auto lean = [&](Solid& solid) {
      for (Eigen::Vector3d& p : solid.vertices) p.head<2>() += slope * (p.z() - tilted.z0_m) * left;
    };
    tilted.slope += slope;
    if (tilted.body) lean(*tilted.body);
    for (Opening* opening : openings_of(tilted)) {
      if (opening->solid) lean(*opening->solid);
      for (Solid& part : opening->parts) lean(part);
    }
    note(entry.op, tilted.id);
  }

  void add_wall(const PlanWallEntry& entry) {
    check_new_id(entry.id);
    const PlanLevel level = level_of(entry.storey);
    check_material(entry.material);
    if ((entry.b - entry.a).norm() < plan_length_min_m)
      throw InputError(at("b"), "wall " + in_quotes(entry.id) + " has zero length; a and b must lie at least " +
                                    metres(plan_length_min_m) + " apart");
    const double height = level.top_z_m - level.floor_z_m;
    if (entry.height_m.value_or(height) > height + touching_m)
      throw InputError(at("height_m"), "wall " + in_quotes(entry.id) + " is higher than its storey, " + metres(height) +
                                           "; it must fit below the ceiling");
    result_.building.walls.push_back(wall_of(entry, level));
    storeys_.insert(level.index);
    note(DeviationOp::add_wall, entry.id);
  }

  void check_opening(const Opening& opening, std::string_view along, std::string_view up) const {
    const Wall& host = result_.building.walls[static_cast<std::size_t>(opening.wall)];
    const double half = 0.5 * opening.width_m;
    const std::string who = "opening " + in_quotes(opening.id);
    if (opening.width_m > host.length() + touching_m)
      throw InputError(at("width_m"), who + " is " + metres(opening.width_m) + " wide, its wall " + in_quotes(host.id) +
                                          " only " + metres(host.length()) + " long");
    if (opening.s_m < half - touching_m || opening.s_m > host.length() - half + touching_m)
      throw InputError(at(along), who + " would reach beyond its wall " + in_quotes(host.id) +
                                      "; its centre must stay between " + metres(half) + " and " +
                                      metres(host.length() - half) + " from a, it would be at " + metres(opening.s_m));
    if (opening.z1_m > host.z1_m + touching_m)
      throw InputError(at(up), who + " ends " + metres(opening.z1_m - host.z0_m) + " above the foot of its wall " +
                                   in_quotes(host.id) + ", which is only " + metres(host.z1_m - host.z0_m) + " high");
    for (const Opening& other : result_.building.openings)
      if (other.id != opening.id && overlap(opening, other))
        throw InputError(at(along), who + " would overlap " + in_quotes(other.id) + " in wall " + in_quotes(host.id));
  }

  void move_opening(const PlanDeviationEntry& entry) {
    std::vector<Opening>& openings = result_.building.openings;
    Opening& opening = openings[find(openings, entry.target, "opening", "opening")];
    if (opening.wall < 0) throw InputError(at("opening"), "opening " + in_quotes(opening.id) + " is in no wall");
    const Wall& host = result_.building.walls[static_cast<std::size_t>(opening.wall)];
    opening.s_m += entry.by_m;
    const Eigen::Vector2d by = entry.by_m * host.direction();
    shift(opening, {by.x(), by.y(), 0.0});
    check_opening(opening, "by_m", "by_m");
    storeys_.insert(host.storey);
    note(entry.op, opening.id);
  }

  void remove_opening(const PlanDeviationEntry& entry) {
    std::vector<Opening>& openings = result_.building.openings;
    openings.erase(openings.begin() + static_cast<std::ptrdiff_t>(find(openings, entry.target, "opening", "opening")));
    note(entry.op, entry.target);
  }

  void add_opening(const PlanOpeningEntry& entry) {
    check_new_id(entry.id);
    const std::size_t host = find(result_.building.walls, entry.wall, "wall", "wall");
    check_material(entry.material);
    const Opening opening = opening_of(entry, "", static_cast<int>(host), result_.building.walls[host]);
    if (opening.kind != OpeningKind::door && opening.leaf != Leaf::none)
      throw InputError(at("leaf"), "opening " + in_quotes(entry.id) + " is not a door; only a door has a leaf");
    check_opening(opening, "s_m", "height_m");
    result_.building.openings.push_back(opening);
    storeys_.insert(result_.building.walls[host].storey);
    note(DeviationOp::add_opening, entry.id);
  }

  void add_clutter(const PlanClutterEntry& entry) {
    check_new_id(entry.id);
    check_material(entry.material);
    Obstacle obstacle = clutter_of(entry, level_of(entry.storey), PlanSolids().cylinder_sides);
    obstacle.planned = false;
    result_.building.obstacles.push_back(std::move(obstacle));
    note(DeviationOp::add_clutter, entry.id);
  }

  void add_column(const PlanColumnEntry& entry) {
    check_new_id(entry.id);
    check_material(entry.material);
    result_.building.columns.push_back(column_of(entry, level_of(entry.storey)));
    note(DeviationOp::add_column, entry.id);
  }

  const Building& as_planned_;
  const Tree& list_;
  std::size_t number_ = 0;
  AsBuilt result_;
  std::set<int> storeys_;  ///< whose rooms may have changed
};

}  // namespace

AsBuilt apply_deviations(const Building& as_planned, const std::vector<PlanDeviationEntry>& deviations,
                         const Tree& list) {
  if (deviations.empty()) return {as_planned, {}};
  Rework rework(as_planned, list);
  for (std::size_t i = 0; i < deviations.size(); ++i) rework.apply(deviations[i], i);
  return rework.finish();
}

}  // namespace plumbline::bim
