// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/moving.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "bim/errors.h"
#include "scenarios/spec/named_places.h"
#include "sim/route/route.h"

namespace plumbline::scenarios {

namespace {

constexpr double leaf_gap_m = 0.01;  ///< between a leaf and its frame, on each side

/// Mark of item i of a list of the file; of the file where the list was not written.
Mark item_mark(const Tree& tree, std::string_view key, std::size_t i) {
  const Tree* list = tree.is_map() ? tree.find(key) : nullptr;
  return list != nullptr && list->is_list() && i < list->as_list().size() ? list->as_list()[i].mark : tree.mark;
}

/// The way from room to room through the free space, in the order of the list.
std::vector<Eigen::Vector2d> walk_through(const bim::Building& building, const PersonSpec& person, int storey,
                                          const sim::ClearanceMap& free_space, const Mark& mark) {
  std::vector<Eigen::Vector2d> points;
  for (const std::string& name : person.rooms) {
    const auto room = static_cast<std::size_t>(find_room_on(building, storey, name, mark));
    const auto targets = free_space.room_targets(building.rooms[room]);
    if (targets.empty()) throw InputError(mark, "there is no room to stand in '" + name + "'");
    if (points.empty()) {
      points.push_back(targets[0]);
      continue;
    }
    const auto in_reach = free_space.reachable(points.back(), targets);
    const auto way = free_space.path(points.back(), in_reach.empty() ? targets[0] : in_reach[0]);
    if (way.empty()) throw InputError(mark, "no person can walk from the room before to '" + name + "'");
    points.insert(points.end(), way.begin() + 1, way.end());
  }
  return points;
}

const bim::Opening& door_named(const bim::Building& building, const std::string& name, const Mark& mark) {
  std::vector<std::string> known;
  for (const bim::Opening& opening : building.openings) {
    if (opening.kind != bim::OpeningKind::door) continue;
    if (opening.id == name || opening.filling_id == name) return opening;
    known.push_back(opening.id);
  }
  const std::string close = did_you_mean(name, known);
  throw InputError(mark, "no door '" + name + "'" + (close.empty() ? "" : "; did you mean '" + close + "'?"));
}

}  // namespace

std::vector<sim::PersonConfig> place_people(const bim::Building& as_built, const Scenario& scenario, const Tree& tree,
                                            int storey) {
  std::vector<sim::PersonConfig> people;
  std::optional<sim::ClearanceMap> free_space;
  const double floor = as_built.storeys.at(static_cast<std::size_t>(storey)).elevation_m;
  for (std::size_t i = 0; i < scenario.people.size(); ++i) {
    const PersonSpec& spec = scenario.people[i];
    const Mark mark = item_mark(tree, "people", i);
    if (spec.rooms.empty() == spec.points.empty())
      throw InputError(mark, "a person walks through either rooms or points");
    std::vector<Eigen::Vector2d> points = spec.points;
    if (points.empty()) {
      if (!free_space) free_space.emplace(as_built, storey);
      points = walk_through(as_built, spec, storey, *free_space, mark);
    }
    sim::PersonConfig& person = people.emplace_back();
    for (const Eigen::Vector2d& p : points) person.points_W.emplace_back(p.x(), p.y(), floor);
    person.speed_mps = spec.speed_mps;
    person.radius_m = spec.radius_m;
    person.height_m = spec.height_m;
  }
  return people;
}

std::vector<sim::SwingDoorConfig> place_doors(const bim::Building& as_built, const Scenario& scenario,
                                              const Tree& tree) {
  std::vector<sim::SwingDoorConfig> doors;
  for (std::size_t i = 0; i < scenario.moving_doors.size(); ++i) {
    const MovingDoorSpec& spec = scenario.moving_doors[i];
    const Mark mark = item_mark(tree, "moving_doors", i);
    const bim::Opening& opening = door_named(as_built, spec.door, mark);
    if (opening.leaf == bim::Leaf::closed)
      throw InputError(mark, "door '" + spec.door +
                                 "' is closed in the building, for good; `leaf: open` or `doors: open` "
                                 "would let it move");
    if (!std::is_sorted(spec.times_s.begin(), spec.times_s.end()))
      throw InputError(mark, "times_s of door '" + spec.door + "' must ascend");
    const bim::Wall& wall = as_built.walls.at(static_cast<std::size_t>(opening.wall));
    const double side = spec.hinge == Hinge::a ? -1.0 : 1.0;
    sim::SwingDoorConfig& door = doors.emplace_back();
    door.width_m = opening.width_m - 2.0 * leaf_gap_m;
    door.height_m = opening.z1_m - opening.z0_m - leaf_gap_m;
    const Eigen::Vector2d hinge = wall.a + (opening.s_m + side * 0.5 * door.width_m) * wall.direction() +
                                  (wall.offset_m + 0.5 * wall.thickness_m) * wall.left();
    door.hinge_W = {hinge.x(), hinge.y(), opening.z0_m};
    const Eigen::Vector2d along = -side * wall.direction();
    door.yaw_closed = std::atan2(along.y(), along.x());
    const double turn = spec.angle_deg * std::numbers::pi / 180.0;
    door.swing = (spec.hinge == Hinge::a) == (spec.swing == Swing::left) ? turn : -turn;
    door.near_m = spec.near_m;
    door.travel_s = spec.travel_s;
    door.times_s = spec.times_s;
  }
  return doors;
}

}  // namespace plumbline::scenarios
