// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "bim/config/tree.h"
#include "bim/formats/ifc/read/interpret.h"
#include "bim/formats/ifc/read/said_floor.h"
#include "bim/model/wall_face.h"

namespace plumbline::bim {
namespace {

/// What the walls, slabs and rooms of a storey cover on the plan.
Eigen::AlignedBox2d box_of_storey(const Building& building, int storey) {
  Eigen::AlignedBox2d box;
  const auto add = [&](const Polygon2& outline) {
    for (const Eigen::Vector2d& p : outline) box.extend(p);
  };
  for (const Wall& wall : building.walls)
    if (wall.storey == storey) add(footprint(wall));
  for (const Slab& slab : building.slabs)
    if (slab.storey == storey) add(slab.polygon.outer);
  for (const Room& room : building.rooms)
    if (room.storey == storey) add(room.polygon);
  return box;
}

/// False for storeys beside each other, such as half levels.
bool lie_over_each_other(const Eigen::AlignedBox2d& a, const Eigen::AlignedBox2d& b) {
  constexpr double least_share = 0.1;
  if (a.isEmpty() || b.isEmpty()) return true;
  const Eigen::AlignedBox2d common = a.intersection(b);
  return !common.isEmpty() && common.volume() > least_share * std::min(a.volume(), b.volume());
}

}  // namespace

void Interpreter::add_storeys() {
  for (const StepProduct& product : model_.products) {
    if (product.kind != StepClass::storey) continue;
    Storey storey;
    storey.id = product.id;
    storey.name = product.name;
    // The attribute Elevation may be null or stale; the placement is what the elements hang on, where there is one.
    const double placed_m = product.X_WP.translation().z();
    storey.elevation_m = snapped(product.placed ? placed_m : product.elevation_m.value_or(placed_m));
    storey.step_id = product.step_id;
    building_.storeys.push_back(std::move(storey));
  }
  move_storeys_to_their_floors();
  leave_out_empty_storeys();
  if (building_.storeys.empty()) assume_storeys();
  std::sort(building_.storeys.begin(), building_.storeys.end(), [](const Storey& a, const Storey& b) {
    return std::tie(a.elevation_m, a.id) < std::tie(b.elevation_m, b.id);
  });
  for (std::size_t i = 0; i < building_.storeys.size(); ++i)
    if (building_.storeys[i].step_id != 0) storeys_[building_.storeys[i].step_id] = static_cast<int>(i);
  name_storeys_apart();
}

/// What makes a level of the file a storey; `lookalikes`: also what may be taken for a wall or a floor.
bool Interpreter::makes_storey(const StepProduct& product, bool lookalikes) const {
  switch (product.kind) {
    case StepClass::wall:
    case StepClass::slab:
    case StepClass::roof:
    case StepClass::space:
    case StepClass::stair:
    case StepClass::stair_flight:
    case StepClass::column:
    case StepClass::curtain_wall:
      return true;
    case StepClass::obstacle:
    case StepClass::part:
      break;
    default:
      return false;
  }
  const std::string kind = obstacle_kind(product.type);
  return kind == "footing" || kind == "ramp" || (lookalikes && is_nameless(product));
}

/// Some programs leave every storey's placement at zero and place the elements themselves; others get it wrong.
void Interpreter::move_storeys_to_their_floors() {
  struct Feet {
    bool near = false;         ///< one of the storey's elements begins near its height
    double lowest = INFINITY;  ///< of its walls and spaces
    FloorHints hints;
  };
  std::map<std::int64_t, double> heights;
  for (const Storey& storey : building_.storeys) heights[storey.step_id] = storey.elevation_m;
  std::map<std::int64_t, Feet> feet;
  for (const StepProduct& product : model_.products) {
    const auto height = heights.find(product.storey);
    if (height == heights.end()) continue;
    Feet& of = feet[product.storey];
    if (product.kind == StepClass::door) {
      const StepProduct* opening = find(product.host);  // a door in one has no body of its own
      const double sill = foot_of(opening != nullptr ? *opening : product);
      if (std::isfinite(sill)) of.hints.doors.push_back(sill);
    }
    // Landings and flights lie at any height; the slabs of a roof are none to stand on.
    if (!within(product, StepClass::stair) && !within(product, StepClass::roof))
      add_hints(product, height->second, of.hints);
    if (!makes_storey(product, false)) continue;
    const double foot = foot_of(product);
    if (!std::isfinite(foot)) continue;
    of.near = of.near || std::abs(foot - height->second) < config_.least_storey_m;
    if (product.kind == StepClass::wall || product.kind == StepClass::space) of.lowest = std::min(of.lowest, foot);
  }
  for (Storey& storey : building_.storeys) {
    const Feet& of = feet[storey.step_id];
    std::vector<double> others;
    for (const auto& [step_id, height_m] : heights)
      if (step_id != storey.step_id) others.push_back(height_m);
    std::optional<double> floor_m = said_floor(of.hints, storey.elevation_m, others);
    if (!floor_m && !of.near && std::isfinite(of.lowest)) floor_m = of.lowest;
    if (!floor_m) continue;
    const StepProduct* product = find(storey.step_id);
    const std::string said =
        product != nullptr && !product->placed && !product->elevation_m
            ? "the file gives it no placement; its slabs, spaces and walls say that its floor lies at "
            : "the file says that it lies at " + format_number(storey.elevation_m) +
                  " m, and its slabs, spaces and walls that its floor does at ";
    building_.warnings.push_back({storey.id, "storey_moved", said + format_number(snapped(*floor_m)) + " m"});
    storey.elevation_m = snapped(*floor_m);
  }
}

/// Programs write every level of a drawing as a storey, such as one for sills. Its elements go to the one below.
void Interpreter::leave_out_empty_storeys() {
  const auto none = [&](StepClass kind) {
    return std::none_of(model_.products.begin(), model_.products.end(),
                        [&](const StepProduct& product) { return product.kind == kind; });
  };
  const bool lookalikes = none(StepClass::wall) || none(StepClass::slab);
  std::set<std::int64_t> built;
  for (const StepProduct& product : model_.products) {
    if (!makes_storey(product, lookalikes)) continue;
    const double foot = foot_of(product);
    const auto own = std::find_if(building_.storeys.begin(), building_.storeys.end(),
                                  [&](const Storey& storey) { return storey.step_id == product.storey; });
    const bool named = own != building_.storeys.end();
    if (named) built.insert(own->step_id);
    // Walls far above the storey that they name, as in a file with all in the lowest.
    const bool elsewhere = product.kind == StepClass::wall && named && foot > own->elevation_m + config_.least_storey_m;
    if ((named && !elsewhere) || !std::isfinite(foot)) continue;
    const Storey* below = nullptr;
    for (const Storey& storey : building_.storeys)
      if (storey.elevation_m <= foot + config_.storey_below_m &&
          (below == nullptr || storey.elevation_m > below->elevation_m))
        below = &storey;
    if (below != nullptr && (!named || below->elevation_m > foot - config_.storey_below_m))
      built.insert(below->step_id);
  }
  if (built.empty()) return;
  std::string list;
  std::sort(building_.storeys.begin(), building_.storeys.end(), [](const Storey& a, const Storey& b) {
    return std::tie(a.elevation_m, a.id) < std::tie(b.elevation_m, b.id);
  });
  for (const Storey& storey : building_.storeys)
    if (!built.contains(storey.step_id))
      list += (list.empty() ? "'" : ", '") + storey.name + "' at " + format_number(storey.elevation_m) + " m";
  if (list.empty()) return;
  std::erase_if(building_.storeys, [&](const Storey& storey) { return !built.contains(storey.step_id); });
  building_.warnings.push_back(
      {"", "empty_storey",
       list + ": no walls, slabs, spaces or stairs; left out, and what is on it belongs to the storey below"});
}

/// Storeys of several buildings get the names of these in front of theirs.
void Interpreter::name_storeys_apart() {
  std::map<std::int64_t, std::string> names;  // of the buildings, by STEP number
  for (std::size_t i = 0; i < building_.storeys.size(); ++i) {
    const StepProduct* product = find(building_.storeys[i].step_id);
    if (product == nullptr || product->building == 0) continue;
    buildings_[static_cast<int>(i)] = product->building;
    names[product->building] = product->building_name;
  }
  if (names.size() < 2) return;
  std::map<std::string, int> times;
  for (const auto& [step_id, name] : names) ++times[name];
  std::string list;
  for (auto& [step_id, name] : names) {
    if (name.empty() || times[name] > 1) name += (name.empty() ? "building #" : " #") + std::to_string(step_id);
    list += (list.empty() ? "'" : ", '") + name + "'";
  }
  for (const auto& [storey, step_id] : buildings_) {
    Storey& named = building_.storeys[static_cast<std::size_t>(storey)];
    named.name = names[step_id] + ": " + named.name;
  }
  building_.warnings.push_back(
      {"", "several_buildings",
       "the file has the buildings " + list +
           "; their storeys have names of both, and a robot walks in one of them; a file each is clearer"});
}

bool Interpreter::same_building(int storey, int other) const {
  const auto a = buildings_.find(storey), b = buildings_.find(other);
  return a == buildings_.end() || b == buildings_.end() || a->second == b->second;
}

Building Interpreter::only_building_of(int storey) const {
  Building only = building_;
  const auto foreign = [&](const auto& element) {
    return element.storey >= 0 && !same_building(storey, element.storey);
  };
  for (std::size_t i = 0; i < only.storeys.size(); ++i)
    if (!same_building(storey, static_cast<int>(i))) only.storeys[i].kind = StoreyKind::foundation;
  // Openings keep their walls, which only lose what they could enclose.
  for (Wall& wall : only.walls)
    if (foreign(wall)) wall.z1_m = wall.z0_m = -std::numeric_limits<double>::max();
  std::erase_if(only.slabs, foreign);
  std::erase_if(only.obstacles, foreign);
  return only;
}

/// Levels at which walls begin, without walls tops of slabs, without these lower ends of other elements, where they lie
/// a storey's height apart.
void Interpreter::assume_storeys() {
  std::vector<double> walls, slabs, others;
  for (const StepProduct& product : model_.products) {
    if (product.kind == StepClass::hidden) continue;
    const double foot = foot_of(product);
    if (!std::isfinite(foot)) continue;
    if (product.kind == StepClass::wall)
      walls.push_back(foot);
    else if (product.kind == StepClass::slab)
      slabs.push_back(top_of(product));
    else
      others.push_back(foot);
  }
  std::vector<double> feet = !walls.empty() ? walls : !slabs.empty() ? slabs : others;
  std::sort(feet.begin(), feet.end());
  for (const double foot : feet) {
    if (!building_.storeys.empty() && foot < building_.storeys.back().elevation_m + config_.least_storey_m) continue;
    Storey storey;
    storey.id = "storey" + std::to_string(building_.storeys.size() + 1);
    storey.name = storey.id;
    storey.elevation_m = snapped(foot);
    building_.storeys.push_back(std::move(storey));
  }
  for (const Storey& storey : building_.storeys)
    building_.warnings.push_back(
        {storey.id, "assumed_storey",
         "the file has no IfcBuildingStorey; one begins at " + format_number(storey.elevation_m) + " m"});
}

void Interpreter::set_heights() {
  std::vector<Eigen::AlignedBox2d> boxes;
  for (std::size_t i = 0; i < building_.storeys.size(); ++i)
    boxes.push_back(box_of_storey(building_, static_cast<int>(i)));
  for (std::size_t i = 0; i < building_.storeys.size(); ++i) {
    Storey& storey = building_.storeys[i];
    const auto next = std::find_if(building_.storeys.begin(), building_.storeys.end(), [&](const Storey& other) {
      const auto k = static_cast<std::size_t>(&other - building_.storeys.data());
      return other.elevation_m > storey.elevation_m && same_building(static_cast<int>(i), static_cast<int>(k)) &&
             lie_over_each_other(boxes[i], boxes[k]);
    });
    double top = storey.elevation_m;
    if (next != building_.storeys.end()) {
      top = next->elevation_m;
    } else {
      for (const Room& room : building_.rooms)
        if (room.storey == static_cast<int>(i)) top = std::max(top, room.z1_m);
      for (const Wall& wall : building_.walls)
        if (wall.storey == static_cast<int>(i)) top = std::max(top, wall.z1_m);
      for (const Obstacle& obstacle : building_.obstacles)
        if (obstacle.storey == static_cast<int>(i) && obstacle.kind == "curtain_panel")
          top = std::max(top, extent(obstacle.body).high.z());
    }
    storey.height_m = snapped(top - storey.elevation_m);
    if (storey.height_m > 0.0) continue;
    storey.height_m = config_.assumed_height_m;
    building_.warnings.push_back({storey.id, "assumed_height", "nothing says how high the storey is; 3 m assumed"});
  }
}

}  // namespace plumbline::bim
