// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/building_map.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bim/config/printable.h"
#include "bim/errors.h"
#include "scenarios/localizability/step_choice.h"

namespace plumbline::scenarios {

namespace {

/// Names, with ids where these do not tell the storeys apart.
std::string names_of(const std::vector<bim::Storey>& storeys) {
  std::string list;
  for (const bim::Storey& storey : storeys) {
    const auto same = std::count_if(storeys.begin(), storeys.end(),
                                    [&](const bim::Storey& other) { return other.name == storey.name; });
    list += (list.empty() ? "" : ", ") + printable(name_of(storey));
    if (same > 1 && !storey.name.empty()) list += " (" + printable(storey.id) + ")";
  }
  return list;
}

std::vector<std::size_t> storeys_asked_for(const bim::Building& building, const BuildingMapOptions& options) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < building.storeys.size(); ++i) {
    const bim::Storey& storey = building.storeys[i];
    const auto on = [&](const auto& thing) { return thing.storey == static_cast<int>(i); };
    const bool rooms = std::any_of(building.rooms.begin(), building.rooms.end(), on);
    const bool walls = std::any_of(building.walls.begin(), building.walls.end(), on);
    const bool habitable = building.rooms.empty() ? walls : rooms;
    if (options.storey ? *options.storey == storey.id || *options.storey == storey.name : habitable) found.push_back(i);
  }
  if (!found.empty()) return found;
  if (options.storey)
    throw InputError({"--storey", 0, 0},
                     "there is no storey '" + *options.storey + "'; there are: " + names_of(building.storeys));
  throw InputError({options.file, 0, 0},
                   "has no storey with rooms or walls, and `identify` maps those; its walls (IfcWall) would help");
}

Tree tree_of(const MapShare& share) {
  Tree tree = Tree::map();
  tree.set("cells", share.cells).set("one_scan", share.one_scan).set("walk", share.walk).set("never", share.never);
  if (share.walk > 0) tree.set("walk_median_m", share.walk_median_m).set("walk_max_m", share.walk_max_m);
  return tree.set("aliases_max", share.aliases_max);
}

Tree tree_of(const CellAnswer& answer) {
  Tree tree = Tree::map();
  tree.set("aliases", answer.aliases);
  if (answer.walk_m) tree.set("walk_m", *answer.walk_m);
  return tree;
}

Tree tree_of(const bim::Building& plan, const Alike& alike) {
  const auto room = [&](int index) {
    return index < 0 ? Tree() : Tree(plan.rooms[static_cast<std::size_t>(index)].id);
  };
  Tree rooms = Tree::list();
  for (const auto& [a, b] : alike.rooms) rooms.push(Tree(Tree::List{room(a), room(b)}));
  const Eigen::Vector3d moved = alike.transform.t;
  Tree tree = Tree::map();
  tree.set("turned_deg", alike.transform.yaw() / rad_per_deg)
      .set("moved_m", Tree(Tree::List{moved.x(), moved.y(), moved.z()}))
      .set("places", alike.places)
      .set("rooms", std::move(rooms));
  if (const auto& by = alike.distinguished)
    tree.set("element", by->element)
        .set("missing", by->missing)
        .set("share", by->share)
        .set("from", Tree(Tree::List{by->from_W.x(), by->from_W.y()}));
  return tree;
}

Tree conditions(const BuildingMap& map, const std::function<bool(const MapCell&)>& of) {
  Tree tree = Tree::map();
  if (!map.options.compass_only) tree.set("unknown", tree_of(share_of(map, false, of)));
  return tree.set("compass", tree_of(share_of(map, true, of)));
}

}  // namespace

std::string name_of(const bim::Storey& storey) { return storey.name.empty() ? storey.id : storey.name; }

namespace {

/// Makes maps of one building at several steps.
class MapMaker {
 public:
  MapMaker(const RunBuilding& building, const BuildingMapOptions& options, PlanEvidence by)
      : building_(building), options_(options), visible_(visible_building(building, by)) {
    if (visible_.featureless)
      throw InputError(
          {options.file, 0, 0},
          "has no wall, column or other element that stays where it is and that a LiDAR sees; no pose in "
          "it is identifiable, and `identify` maps buildings that have some; its walls (IfcWall) would help");
    input_.as_planned = &visible_.planned.scene;
    input_.as_built = &visible_.as_built().scene;
    input_.loose = visible_.loose;
    input_.isometries = visible_.isometries;
    input_.step_m = options.step_m;
    input_.across = options.across;
    input_.compass_only = options.compass_only;
    input_.threads = options.threads;
    for (std::size_t i = 0; i < building.as_planned().storeys.size(); ++i)
      input_.storeys.push_back(search_area(building.as_planned(), i));
    if (options.budget_s) index_.emplace(index_of(input_));
  }

  [[nodiscard]] BuildingMap at(double step_m, const std::string& expected = "") {
    BuildingMap result;
    result.options = options_;
    result.options.step_m = step_m;
    for (const std::size_t storey : storeys_asked_for(building_.as_planned(), options_))
      result.floors.push_back(floor_of(building_.as_built(), storey, step_m));
    for (const Floor& floor : result.floors)
      if (floor.cells_W.empty() && building_.as_planned().storeys[floor.storey].kind == bim::StoreyKind::habitable)
        result.bare.push_back(floor.storey);  // nobody expects places on a roof
    std::erase_if(result.floors, [](const Floor& floor) { return floor.cells_W.empty(); });
    std::size_t places = 0;
    for (const Floor& floor : result.floors) places += floor.cells_W.size();
    LocalizabilityMapInput input = input_;
    input.floors = result.floors;
    input.step_m = step_m;
    if (index_) input.index = &*index_;
    const std::string what =
        "a place every " + format_number(step_m) + " m, " + std::to_string(places) + " places" + expected;
    if (options_.phase && options_.budget_s) options_.phase(what);
    input.progress = options_.progress;
    result.map = compute_localizability_map(input);
    return result;
  }

  [[nodiscard]] AlikePlaces alike_in(const BuildingMap& map) const {
    return alike_places(building_.as_planned(), visible_, input_.storeys, map.floors, map.map);
  }

  /// The finest map that fits the budget: coarse ones first, whose work says what a finer one would take.
  [[nodiscard]] BuildingMap within(double budget_s) {
    StepBudget budget;
    double left = budget_s * budget.cores * budget.beams_per_core_s - static_cast<double>(index_->beams());
    const double first = coarse_step(floor_area(), options_.step_m);
    BuildingMap map = at(first);
    MapWork work{first, map.map.cells.size(), map.map.beams};
    left -= static_cast<double>(work.beams);
    for (const bool last : {false, true}) {
      const double least = last ? options_.step_m : std::max(options_.step_m, first / std::sqrt(budget.more_places));
      const double step = finest_step(work, left, least, budget);
      if (step >= work.step_m) break;
      const double expected_s = expected_beams(work, step, budget) / budget.cores / budget.beams_per_core_s;
      map = at(step, ", at most about " + std::to_string(std::lround(std::max(expected_s, 1.0))) + " s on two cores");
      const MapWork finer{step, map.map.cells.size(), map.map.beams};
      budget.growth = growth_between(work, finer);
      left -= static_cast<double>(finer.beams);
      work = finer;
    }
    return map;
  }

 private:
  /// Of the rooms asked about, or of the search areas where there are none.
  [[nodiscard]] double floor_area() const {
    double area = 0.0;
    for (const std::size_t storey : storeys_asked_for(building_.as_planned(), options_)) {
      const SearchArea& box = input_.storeys[storey];
      double rooms = 0.0;
      for (const bim::Room& room : building_.as_planned().rooms)
        if (room.storey == static_cast<int>(storey)) rooms += room.area_m2();
      area += rooms > 0.0 ? rooms : box.empty() ? 0.0 : (box.max - box.min).prod();
    }
    return area;
  }

  const RunBuilding& building_;
  const BuildingMapOptions& options_;
  VisibleBuilding visible_;
  LocalizabilityMapInput input_;
  std::optional<PlaceIndex> index_;
};

}  // namespace

BuildingMap map_of(const RunBuilding& building, const BuildingMapOptions& options, PlanEvidence by) {
  MapMaker maker(building, options, by);
  BuildingMap map = options.budget_s ? maker.within(*options.budget_s) : maker.at(options.step_m);
  if (map.floors.empty())
    throw InputError({options.file, 0, 0},
                     "has no place in its rooms where the robot can stand; `inspect --walk` says "
                     "what stops it, and a smaller --step finds smaller places");
  map.alike = maker.alike_in(map);
  return map;
}

BuildingMaps maps_of(const RunBuilding& building, const BuildingMapOptions& options) {
  if (!building.movables_tell()) return {map_of(building, options, PlanEvidence::building), std::nullopt};
  BuildingMapOptions first = options;
  if (options.budget_s) first.budget_s = 0.5 * *options.budget_s;
  BuildingMaps maps{map_of(building, first, PlanEvidence::building), std::nullopt};
  BuildingMapOptions second = options;  // both answers are of the same places
  second.step_m = maps.building.options.step_m;
  second.budget_s.reset();
  maps.with_furniture = map_of(building, second, PlanEvidence::with_furniture);
  return maps;
}

MapShare share_of(const BuildingMap& map, bool compass, const std::function<bool(const MapCell&)>& of) {
  MapShare share;
  std::vector<double> walks;
  for (const MapCell& cell : map.map.cells) {
    if (!of(cell)) continue;
    const CellAnswer& answer = compass ? cell.compass : cell.unknown.value();
    ++share.cells;
    share.aliases_max = std::max(share.aliases_max, answer.aliases);
    if (!answer.walk_m)
      ++share.never;
    else if (*answer.walk_m == 0.0)
      ++share.one_scan;
    else
      walks.push_back(*answer.walk_m);
  }
  std::sort(walks.begin(), walks.end());
  share.walk = static_cast<int>(walks.size());
  if (walks.empty()) return share;
  share.walk_median_m = walks[walks.size() / 2];
  share.walk_max_m = walks.back();
  return share;
}

namespace {

/// Sets the answers of storeys, rooms and cells.
void set_answers(const bim::Building& plan, const BuildingMap& map, Tree& tree) {
  Tree storeys = Tree::list(), rooms = Tree::list(), cells = Tree::list();
  for (std::size_t f = 0; f < map.floors.size(); ++f)
    storeys.push(Tree::map()
                     .set("id", plan.storeys[map.floors[f].storey].id)
                     .set("answers", conditions(map, [&](const MapCell& cell) { return cell.floor == f; })));
  for (const bim::Room& room : plan.rooms) {
    const auto in_room = [&](const MapCell& cell) {
      return static_cast<int>(map.floors[cell.floor].storey) == room.storey && room.contains(cell.p_W);
    };
    if (share_of(map, true, in_room).cells == 0) continue;
    rooms.push(Tree::map().set("id", room.id).set("name", room.name).set("answers", conditions(map, in_room)));
  }
  for (const MapCell& cell : map.map.cells) {
    Tree one = Tree::map();
    one.set("storey", plan.storeys[map.floors[cell.floor].storey].id);
    one.set("x", cell.p_W.x()).set("y", cell.p_W.y());
    if (cell.unknown) one.set("unknown", tree_of(*cell.unknown));
    one.set("compass", tree_of(cell.compass));
    cells.push(std::move(one));
  }
  Tree alike = Tree::list();
  for (const Alike& one : map.alike.motions) alike.push(tree_of(plan, one));
  tree.set("storeys", storeys).set("rooms", rooms).set("cells", cells).set("alike", alike);
  if (map.alike.others > 0) tree.set("alike_more", static_cast<int>(map.alike.others));
  if (map.bare.empty()) return;
  Tree bare = Tree::list();
  for (const std::size_t storey : map.bare) bare.push(plan.storeys[storey].id);
  tree.set("without_places", bare);
}

std::string table_of(const RunBuilding& building, const BuildingMap& map) {
  std::string text = "storey                 heading   places  one scan      walk (median, longest)   never\n";
  for (std::size_t f = 0; f < map.floors.size(); ++f)
    for (const bool compass : {false, true}) {
      if (!compass && map.options.compass_only) continue;
      const MapShare s = share_of(map, compass, [&](const MapCell& cell) { return cell.floor == f; });
      const double all = std::max(s.cells, 1);
      char line[200], walk[40] = "      -        -  ";
      if (s.walk > 0) std::snprintf(walk, sizeof walk, "(%5.1f m, %5.1f m)", s.walk_median_m, s.walk_max_m);
      std::snprintf(line, sizeof line, "%-22.22s %-8s %7d   %5.1f %%   %5.1f %% %-18s  %5.1f %%\n",
                    printable(name_of(building.as_planned().storeys[map.floors[f].storey])).c_str(),
                    compass ? "compass" : "unknown", s.cells, 100.0 * s.one_scan / all, 100.0 * s.walk / all, walk,
                    100.0 * s.never / all);
      text += line;
    }
  for (const std::size_t storey : map.bare)
    text += printable(name_of(building.as_planned().storeys[storey])) +
            ": no place in its rooms where the robot can stand; `inspect --walk` says what stops it\n";
  return text;
}

}  // namespace

Tree localizability_json(const RunBuilding& building, const BuildingMaps& maps) {
  Tree tree = Tree::map();
  tree.set("step_m", maps.building.options.step_m).set("across", maps.building.options.across);
  tree.set("beams", static_cast<std::int64_t>(maps.building.map.beams));
  set_answers(building.as_planned(), maps.building, tree);
  if (!maps.with_furniture) return tree;
  Tree with_furniture = Tree::map();
  set_answers(building.as_planned(), *maps.with_furniture, with_furniture);
  return tree.set("with_furniture", std::move(with_furniture));
}

std::string scanned_text(const RunBuilding& building) {
  const auto count =  // rooms follow from the rest
      std::ranges::count_if(building.variants().changes,
                            [](const bim::Change& change) { return !change.op.ends_with("_room"); });
  if (count == 0) return "";
  return "The scans are of the building as built, which differs from its plan in " + std::to_string(count) +
         (count == 1 ? " element." : " elements.");
}

std::string localizability_text(const RunBuilding& building, const BuildingMaps& maps) {
  const std::string scanned = scanned_text(building);
  std::string text = "a place every " + format_number(maps.building.options.step_m) + " m\n" + scanned +
                     (scanned.empty() ? "" : "\n") + "By the building alone:\n" + table_of(building, maps.building);
  if (!maps.with_furniture)
    return text + "The plan has no furniture or other object that may have moved; the answer is the same with it.\n";
  return text + "With the furniture as planned:\n" + table_of(building, *maps.with_furniture);
}

}  // namespace plumbline::scenarios
