// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "bim/errors.h"
#include "bim/formats/plan_yaml/message_text.h"
#include "bim/formats/plan_yaml/plan_file.h"
#include "bim/formats/plan_yaml/stair_builder.h"
#include "bim/model/materials.h"

namespace plumbline::bim {

namespace {

constexpr double touching_m = 1e-6;  ///< openings may touch each other and the ends of their wall

using Ids = std::map<std::string_view, std::size_t>;

/// Where each id stands in its list; of doubled ones the first.
template <class Entry>
Ids ids_of(const std::vector<Entry>& entries) {
  Ids ids;
  for (std::size_t i = 0; i < entries.size(); ++i) ids.emplace(entries[i].id, i);
  return ids;
}

/// Finds the place of entry i of a list, or of one of its values, and storeys and walls by their ids.
class Places {
 public:
  Places(const PlanFile& plan, const Tree& root)
      : storeys(ids_of(plan.storeys)), walls(ids_of(plan.walls)), root_(root) {}

  const Ids storeys, walls;

  [[nodiscard]] Mark list(std::string_view section) const {
    const Tree* tree = root_.find(section);
    return tree != nullptr ? tree->mark : root_.mark;
  }
  [[nodiscard]] Mark entry(std::string_view section, std::size_t i) const { return item(section, i).mark; }
  [[nodiscard]] Mark value(std::string_view section, std::size_t i, std::string_view key) const {
    const Tree* tree = item(section, i).find(key);
    return tree != nullptr ? tree->mark : item(section, i).mark;
  }
  [[nodiscard]] Mark value(std::string_view section, std::size_t i, std::string_view key, std::size_t k) const {
    return item(section, i).find(key)->as_list().at(k).mark;
  }

 private:
  [[nodiscard]] const Tree& item(std::string_view section, std::size_t i) const {
    return root_.find(section)->as_list().at(i);
  }
  const Tree& root_;
};

template <class Entry>
void check_ids(const std::vector<Entry>& entries, std::string_view section, const Places& places,
               std::set<std::string>& taken) {
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::string& id = entries[i].id;
    const Mark mark = places.value(section, i, "id");
    check_plan_id(id, mark);
    if (!taken.insert(id).second) throw InputError(mark, "the id " + in_quotes(id) + " is taken; ids must be unique");
  }
}

/// Index of a referenced entry, or InputError with the closest known id.
std::size_t refer(const Ids& ids, const std::string& id, const std::string& kind, const Mark& mark) {
  const auto found = ids.find(id);
  if (found != ids.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [name, index] : ids) known.emplace_back(name);
  const std::string guess = did_you_mean(id, known);
  throw InputError(mark,
                   "there is no " + kind + " " + in_quotes(id) +
                       (guess.empty() ? "; name one that the plan lists" : "; did you mean " + in_quotes(guess) + "?"));
}

/// Lists that would keep the reader busy for minutes are no plan of a building.
void check_sizes(const PlanFile& plan, const Places& places) {
  const auto check = [&](std::string_view section, std::size_t size, std::size_t most) {
    if (size > most)
      throw InputError(places.list(section), "the plan lists " + std::to_string(size) + " " + std::string(section) +
                                                 "; at most " + std::to_string(most) + " can be read");
  };
  check("storeys", plan.storeys.size(), plan_storeys_max);
  check("walls", plan.walls.size(), plan_entries_max);
  check("openings", plan.openings.size(), plan_entries_max);
  check("rooms", plan.rooms.size(), plan_entries_max);
  check("columns", plan.columns.size(), plan_entries_max);
  check("stairs", plan.stairs.size(), plan_storeys_max);
  check("clutter", plan.clutter.size(), plan_entries_max);
  check("materials", plan.materials.size(), plan_entries_max);
  check("deviations", plan.deviations.size(), plan_storeys_max);
  for (std::size_t i = 0; i < plan.rooms.size(); ++i)
    if (plan.rooms[i].polygon.size() > plan_corners_max)
      throw InputError(places.value("rooms", i, "polygon"), "the polygon of room " + in_quotes(plan.rooms[i].id) +
                                                                " has " + std::to_string(plan.rooms[i].polygon.size()) +
                                                                " corners; at most " +
                                                                std::to_string(plan_corners_max) + " can be read");
}

void check_all_ids(const PlanFile& plan, const Places& places) {
  std::set<std::string> storeys, solids, openings, rooms, materials;
  check_ids(plan.storeys, "storeys", places, storeys);
  check_ids(plan.walls, "walls", places, solids);
  check_ids(plan.columns, "columns", places, solids);
  check_ids(plan.clutter, "clutter", places, solids);
  check_ids(plan.stairs, "stairs", places, solids);
  check_ids(plan.openings, "openings", places, openings);
  check_ids(plan.rooms, "rooms", places, rooms);
  check_ids(plan.materials, "materials", places, materials);
}

void check_copies(const PlanFile& plan, const Places& places) {
  for (std::size_t i = 0; i < plan.storeys.size(); ++i) {
    const PlanStoreyEntry& storey = plan.storeys[i];
    if (storey.copy_of.empty()) continue;
    const Mark mark = places.value("storeys", i, "copy_of");
    const std::size_t source = refer(places.storeys, storey.copy_of, "storey", mark);
    if (source == i) throw InputError(mark, "storey " + in_quotes(storey.id) + " copies itself; name another storey");
    if (!plan.storeys[source].copy_of.empty())
      throw InputError(mark, in_quotes(storey.copy_of) + " is a copy itself; name the storey it copies, " +
                                 in_quotes(plan.storeys[source].copy_of));
  }
}

/// Storeys stand above each other without common height.
void check_heights(const PlanFile& plan, const Places& places) {
  for (std::size_t i = 0; i < plan.storeys.size(); ++i) {
    for (std::size_t j = 0; j < plan.storeys.size(); ++j) {
      const PlanStoreyEntry &lower = plan.storeys[j], &upper = plan.storeys[i];
      const bool above = upper.elevation_m > lower.elevation_m || (upper.elevation_m == lower.elevation_m && i > j);
      const double top = lower.elevation_m + storey_height(plan, lower);
      if (i == j || !above || upper.elevation_m >= top - touching_m) continue;
      throw InputError(places.value("storeys", i, "elevation_m"),
                       "storey " + in_quotes(upper.id) + " begins at " + metres(upper.elevation_m) +
                           ", below the top of " + in_quotes(lower.id) + "; it must be at least " + metres(top));
    }
  }
}

/// Of a storey and its copies the lowest; the storey itself before its copies.
const PlanStoreyEntry& lowest_of_copies(const PlanFile& plan, const PlanStoreyEntry& storey) {
  const PlanStoreyEntry* lowest = &storey;
  for (const PlanStoreyEntry& other : plan.storeys)
    if (other.copy_of == storey.id && storey_height(plan, other) < storey_height(plan, *lowest)) lowest = &other;
  return *lowest;
}

void check_wall(const PlanFile& plan, std::size_t i, const Places& places) {
  const PlanWallEntry& wall = plan.walls[i];
  const std::size_t storey = refer(places.storeys, wall.storey, "storey", places.value("walls", i, "storey"));
  if ((wall.b - wall.a).norm() < plan_length_min_m)
    throw InputError(places.value("walls", i, "b"), "wall " + in_quotes(wall.id) +
                                                        " has zero length; a and b must lie at least " +
                                                        metres(plan_length_min_m) + " apart");
  const PlanStoreyEntry& lowest = lowest_of_copies(plan, plan.storeys[storey]);
  const double height = storey_height(plan, lowest);
  const std::string which =
      lowest.id == wall.storey ? "its storey, " : in_quotes(lowest.id) + ", the copy of its storey, ";
  if (wall.height_m.value_or(height) > height + touching_m)
    throw InputError(places.value("walls", i, "height_m"), "wall " + in_quotes(wall.id) + " is higher than " + which +
                                                               metres(height) + "; it must fit below the ceiling");
}

void check_opening(const PlanFile& plan, std::size_t i, const Places& places) {
  const PlanOpeningEntry& opening = plan.openings[i];
  const auto at = [&](std::string_view key) { return places.value("openings", i, key); };
  const PlanWallEntry& wall = plan.walls[refer(places.walls, opening.wall, "wall", at("wall"))];
  const double length = (wall.b - wall.a).norm();
  const std::string who = "opening " + in_quotes(opening.id);
  if (opening.width_m > length + touching_m)
    throw InputError(at("width_m"), who + " is " + metres(opening.width_m) + " wide, its wall " + in_quotes(wall.id) +
                                        " only " + metres(length) + " long");
  const double half = 0.5 * opening.width_m;
  if (opening.s_m < half - touching_m || opening.s_m > length - half + touching_m)
    throw InputError(at("s_m"), who + " reaches beyond its wall " + in_quotes(wall.id) + "; s_m must lie between " +
                                    metres(half) + " and " + metres(length - half));
  const auto storey = static_cast<std::size_t>(find_entry(plan.storeys, wall.storey));
  const PlanStoreyEntry& lowest = lowest_of_copies(plan, plan.storeys[storey]);
  const double height = wall.height_m.value_or(storey_height(plan, lowest));
  const std::string where =
      wall.height_m || lowest.id == wall.storey ? "" : " on " + in_quotes(lowest.id) + ", the copy of its storey";
  if (opening.sill_m + opening.height_m > height + touching_m)
    throw InputError(at("height_m"), who + " ends at " + metres(opening.sill_m + opening.height_m) + ", its wall " +
                                         in_quotes(wall.id) + " is only " + metres(height) + " high" + where);
  if (opening.kind != OpeningKind::door && opening.leaf.value_or(Leaf::none) != Leaf::none)
    throw InputError(at("leaf"), who + " is not a door; only a door has a leaf");
}

bool overlap(const PlanOpeningEntry& a, const PlanOpeningEntry& b) {
  const double along = 0.5 * (a.width_m + b.width_m) - std::abs(a.s_m - b.s_m);
  const double up = std::min(a.sill_m + a.height_m, b.sill_m + b.height_m) - std::max(a.sill_m, b.sill_m);
  return a.wall == b.wall && along > touching_m && up > touching_m;
}

void check_overlaps(const PlanFile& plan, const Places& places) {
  std::map<std::string_view, std::vector<std::size_t>> by_wall;
  for (std::size_t i = 0; i < plan.openings.size(); ++i) {
    std::vector<std::size_t>& others = by_wall[plan.openings[i].wall];
    for (const std::size_t j : others)
      if (overlap(plan.openings[i], plan.openings[j]))
        throw InputError(places.value("openings", i, "s_m"),
                         "opening " + in_quotes(plan.openings[i].id) + " overlaps " + in_quotes(plan.openings[j].id) +
                             " in wall " + in_quotes(plan.openings[i].wall) + "; move or narrow one of them");
    others.push_back(i);
  }
}

void check_room(const PlanFile& plan, std::size_t i, const Places& places) {
  const PlanRoomEntry& room = plan.rooms[i];
  (void)refer(places.storeys, room.storey, "storey", places.value("rooms", i, "storey"));
  const Mark outline = places.value("rooms", i, "polygon");
  if (room.polygon.size() < 3)
    throw InputError(outline, "the polygon of room " + in_quotes(room.id) + " needs at least 3 corners");
  if (!is_simple(room.polygon))
    throw InputError(outline, "the polygon of room " + in_quotes(room.id) +
                                  " touches or crosses itself; list its corners once, in order around the room");
  for (std::size_t k = 0; k < room.walls.size(); ++k) {
    const Mark mark = places.value("rooms", i, "walls", k);
    const PlanWallEntry& wall = plan.walls[refer(places.walls, room.walls[k], "wall", mark)];
    if (wall.storey != room.storey)
      throw InputError(mark, "wall " + in_quotes(wall.id) + " stands on storey " + in_quotes(wall.storey) + ", room " +
                                 in_quotes(room.id) + " on " + in_quotes(room.storey));
  }
}

void check_stair(const PlanFile& plan, std::size_t i, const Places& places) {
  const PlanStairEntry& stair = plan.stairs[i];
  const auto at = [&](std::string_view key) { return places.value("stairs", i, key); };
  const std::string who = "stair " + in_quotes(stair.id);
  const double foot = plan.storeys[refer(places.storeys, stair.from, "storey", at("from"))].elevation_m;
  const double head = plan.storeys[refer(places.storeys, stair.to, "storey", at("to"))].elevation_m;
  if (head <= foot + touching_m)
    throw InputError(at("to"),
                     who + " must lead up: storey " + in_quotes(stair.to) + " is not above " + in_quotes(stair.from));
  if (const auto fault = step_fault(stair, head - foot))
    throw InputError(at(stair.landing_after ? "landing_after" : "to"), who + " " + *fault);
  if (stair.turn != Turn::none && !stair.landing_after)
    throw InputError(at("turn"), who + " can turn only at a landing; give landing_after");
  const bool quarter = stair.turn == Turn::left || stair.turn == Turn::right;
  if (quarter && stair.landing_m.value_or(stair.width_m) < stair.width_m - touching_m)
    throw InputError(at("landing_m"), who + " turns on a landing that is less deep than the stair is wide; landing_m " +
                                          "must be at least " + metres(stair.width_m));
}

template <class Entry>
void check_materials_of(const Building& materials, const std::vector<Entry>& entries, std::string_view section,
                        const Places& places) {
  for (std::size_t i = 0; i < entries.size(); ++i)
    if (!entries[i].material.empty())
      check_material_id(materials, entries[i].material, places.value(section, i, "material"));
}

void check_all_materials(const PlanFile& plan, const Places& places) {
  Building declared;
  declared.materials.assign(plan.materials.begin(), plan.materials.end());
  for (std::size_t i = 0; i < plan.storeys.size(); ++i)
    if (!plan.storeys[i].floor_material.empty())
      check_material_id(declared, plan.storeys[i].floor_material, places.value("storeys", i, "floor_material"));
  check_materials_of(declared, plan.walls, "walls", places);
  check_materials_of(declared, plan.openings, "openings", places);
  check_materials_of(declared, plan.columns, "columns", places);
  check_materials_of(declared, plan.clutter, "clutter", places);
  check_materials_of(declared, plan.stairs, "stairs", places);
}

template <class Entry>
void check_storey_of(const std::vector<Entry>& entries, std::string_view section, const Places& places) {
  for (std::size_t i = 0; i < entries.size(); ++i)
    (void)refer(places.storeys, entries[i].storey, "storey", places.value(section, i, "storey"));
}

}  // namespace

double storey_height(const PlanFile& plan, const PlanStoreyEntry& storey) {
  constexpr double usual_height_m = 3.0;
  if (storey.height_m) return *storey.height_m;
  const int source = storey.copy_of.empty() ? -1 : find_entry(plan.storeys, storey.copy_of);
  return source < 0 ? usual_height_m : plan.storeys[static_cast<std::size_t>(source)].height_m.value_or(usual_height_m);
}

void check_plan_id(const std::string& id, const Mark& mark) {
  if (id.empty()) throw InputError(mark, "an id must not be empty");
  if (id.find('/') != std::string::npos)
    throw InputError(mark, "the id " + in_quotes(id) + " contains '/', which is kept for copies of storeys");
}

void check_material_id(const Building& building, const std::string& material, const Mark& mark) {
  if (find_material(building, material) != nullptr) return;
  std::vector<std::string> known;
  for (const Material& own : building.materials) known.push_back(own.id);
  for (const Material& preset : preset_materials()) known.push_back(preset.id);
  const std::string close = did_you_mean(material, known);
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  std::string list;
  for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
  throw InputError(mark, "there is no material " + in_quotes(material) +
                             (close.empty() ? "; known: " + list : "; did you mean " + in_quotes(close) + "?"));
}

void check_plan(const PlanFile& plan, const Tree& tree) {
  const Places places(plan, tree);
  check_sizes(plan, places);
  if (plan.storeys.empty()) throw InputError(places.list("storeys"), "the plan has no storeys; it needs at least one");
  if (plan.walls.empty()) throw InputError(places.list("walls"), "the plan has no walls; it needs at least one");
  check_all_ids(plan, places);
  check_copies(plan, places);
  check_heights(plan, places);
  for (std::size_t i = 0; i < plan.walls.size(); ++i) check_wall(plan, i, places);
  for (std::size_t i = 0; i < plan.openings.size(); ++i) check_opening(plan, i, places);
  check_overlaps(plan, places);
  for (std::size_t i = 0; i < plan.rooms.size(); ++i) check_room(plan, i, places);
  check_storey_of(plan.columns, "columns", places);
  check_storey_of(plan.clutter, "clutter", places);
  for (std::size_t i = 0; i < plan.stairs.size(); ++i) check_stair(plan, i, places);
  check_all_materials(plan, places);
  if (plan.symmetry) check_plan_symmetry(plan, tree);
}

}  // namespace plumbline::bim
