// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/route_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "bim/model/stair_flight.h"
#include "scenarios/spec/closed_doors.h"
#include "scenarios/spec/exploration_route.h"
#include "scenarios/spec/named_places.h"
#include "sim/route/multi_storey_planner.h"

namespace plumbline::scenarios {

namespace {

using sim::FloorPoint;
using Path = std::vector<sim::Waypoint>;

constexpr std::string_view all_rooms = "all";
/// Start points and headings are written with this many decimals (0.1 mm), so that the resolved file reads well.
constexpr double coordinate_steps = 1e4;

constexpr double shuttle_min_m = 0.5;  ///< of a way worth walking to and fro

double round_coordinate(double x) { return std::round(x * coordinate_steps) / coordinate_steps; }

Eigen::Vector2d rounded(const Eigen::Vector2d& p) { return {round_coordinate(p.x()), round_coordinate(p.y())}; }

std::string text(const Eigen::Vector2d& p) { return "[" + format_number(p.x()) + ", " + format_number(p.y()) + "]"; }

/// In the plane, openings included.
bool in_body(const bim::Wall& wall, const Eigen::Vector2d& p) {
  const double along = (p - wall.a).dot(wall.direction());
  const double across = (p - wall.a).dot(wall.left());
  return along >= 0.0 && along <= wall.length() && across >= wall.offset_m &&
         across <= wall.offset_m + wall.thickness_m;
}

/// Where in the plane a stair stands.
bool on_stair(const bim::Stair& stair, const Eigen::Vector2d& p) {
  return std::any_of(stair.flights.begin(), stair.flights.end(),
                     [&](const bim::StairFlight& f) {
                       return f.steps > 0 && contains(bim::steps_outline(f, 0, f.steps - 1), p);
                     }) ||
         std::any_of(stair.landings.begin(), stair.landings.end(),
                     [&](const bim::Landing& landing) { return contains(landing.polygon, p); });
}

/// Plans from a start on one storey of a building, with the place in the file to blame.
class Planner {
 public:
  Planner(const bim::Building& building, int storey, const RouteMarks& marks)
      : building_(building), storey_(storey), marks_(marks), space_(building) {}

  [[nodiscard]] Eigen::Vector2d place(const Start& start) const {
    if (start.at) return check_start(*start.at);
    if (!start.room && building_.rooms.empty()) return freest_place();
    return target(start.room ? find_room(building_, *start.room, marks_.start) : largest_room(), marks_.start).p_W;
  }

  /// Room indices in the order of the walk and the waypoints through them.
  void walk(const Route& route, RoutePlan& plan) const {
    plan.waypoints = sim::on_floor({plan.start_W}, elevation(storey_));
    FloorPoint at{storey_, plan.start_W};
    if (route.shuttle) return shuttle(route, at, plan);
    const bool all = route.rooms.size() == 1 && route.rooms.front() == all_rooms;
    if (all && building_.rooms.empty()) return walk_round(route.loop, plan);
    if (all) return walk_all(route, at, plan);
    for (int lap = 0; lap < route.loop; ++lap)
      for (std::size_t i = 0; i < route.rooms.size(); ++i) walk_to(route.rooms[i], mark_of(i), at, plan);
    plan.rooms = route.rooms;
  }

 private:
  [[nodiscard]] const Mark& mark_of(std::size_t i) const {
    return i < marks_.rooms.size() ? marks_.rooms[i] : marks_.route;
  }

  [[nodiscard]] double elevation(int storey) const {
    return building_.storeys.at(static_cast<std::size_t>(storey)).elevation_m;
  }

  [[nodiscard]] const bim::Room& room(int index) const { return building_.rooms[static_cast<std::size_t>(index)]; }

  [[nodiscard]] Eigen::Vector2d check_start(const Eigen::Vector2d& at) const {
    const std::string start = "the start " + text(at);
    const bool doorway = in_a_doorway(building_, storey_, at);
    for (const bim::Wall& wall : building_.walls)
      if (!doorway && wall.storey == storey_ && in_body(wall, at))
        throw InputError(marks_.start, start + " is inside a wall ('" + wall.id + "'); it must be in a room");
    for (const bim::Stair& stair : building_.stairs)
      if ((stair.from == storey_ || stair.to == storey_) && on_stair(stair, at))
        throw InputError(marks_.start, start + " is on stair '" + stair.id + "'; it must be on the floor of a storey");
    const auto in_room = [&](const bim::Room& r) { return r.storey == storey_ && contains(r.polygon, at); };
    const bool has_rooms = std::any_of(building_.rooms.begin(), building_.rooms.end(),
                                       [&](const bim::Room& r) { return r.storey == storey_; });
    if (has_rooms && !doorway && std::none_of(building_.rooms.begin(), building_.rooms.end(), in_room))
      throw InputError(marks_.start, start + " is outside every room; it must be in a room");
    if (!space_.storey(storey_).free(at))
      throw InputError(marks_.start, start + " is in or too near to a wall or another thing (" +
                                         format_number(round_coordinate(space_.storey(storey_).clearance(at))) +
                                         " m clear); the robot needs more room around it");
    return at;
  }

  /// Box around the floor of the start's storey.
  [[nodiscard]] Eigen::AlignedBox2d floor_box() const {
    Eigen::AlignedBox2d box;
    for (const bim::Slab& slab : building_.slabs)
      for (const Eigen::Vector2d& p : slab.polygon.outer)
        if (slab.storey == storey_) box.extend(p);
    return box;
  }

  /// The freest place of a room, if the robot fits in it.
  [[nodiscard]] std::optional<FloorPoint> place_in(int storey, const Polygon2& polygon) const {
    const std::vector<Eigen::Vector2d> found = space_.storey(storey).room_target(polygon);
    if (found.empty()) return std::nullopt;
    return FloorPoint{storey, rounded(found.front())};
  }

  /// Where no rooms are known.
  [[nodiscard]] Eigen::Vector2d freest_place() const {
    const std::vector<Eigen::Vector2d> found = space_.storey(storey_).open_target();
    if (found.empty()) throw InputError(marks_.start, "there is no place on the floor where the robot fits");
    return rounded(found.front());
  }

  /// Where no rooms are known, or none but the one of the start is in reach.
  void walk_round(int laps, RoutePlan& plan) const {
    const Eigen::AlignedBox2d box = floor_box();
    const Path round = box.isEmpty() ? Path{}
                                     : sim::with_clearance(space_.storey(storey_),
                                                           exploration_route(space_.storey(storey_), box, plan.start_W),
                                                           elevation(storey_));
    for (int lap = 0; lap < laps; ++lap) append(round, plan);
    plan.rooms = {std::string(all_rooms)};
  }

  /// Rooms of the start's storey that can be stood in, largest first (ties: lower index).
  [[nodiscard]] int largest_room() const {
    int best = -1;
    double best_area = 0.0;
    for (std::size_t i = 0; i < building_.rooms.size(); ++i) {
      const bim::Room& candidate = building_.rooms[i];
      const double area = std::abs(signed_area(candidate.polygon));
      if (candidate.storey != storey_ || area <= best_area || !place_in(storey_, candidate.polygon)) continue;
      best = static_cast<int>(i);
      best_area = area;
    }
    if (best < 0) throw InputError(marks_.start, "no room to start in; give a start: {storey: ..., at: [x, y]}");
    return best;
  }

  [[nodiscard]] FloorPoint target(int index, const Mark& mark) const {
    const std::optional<FloorPoint> found = place_in(room(index).storey, room(index).polygon);
    if (!found)
      throw InputError(mark, "room '" + room(index).id + "' has no place where the robot can turn round; it needs " +
                                 format_number(2.0 * sim::RouteConfig().turn_m) + " m");
    return *found;
  }

  static void append(const Path& path, RoutePlan& plan) {
    plan.waypoints.insert(plan.waypoints.end(), path.begin() + (path.empty() ? 0 : 1), path.end());
  }

  void walk_to(const std::string& name, const Mark& mark, FloorPoint& at, RoutePlan& plan) const {
    const FloorPoint goal = target(find_room(building_, name, mark), mark);
    const Path leg = space_.path(at, goal);
    if (leg.empty()) refuse(name, at, goal, mark);
    append(leg, plan);
    at = goal;
  }

  [[noreturn]] void refuse(const std::string& name, const FloorPoint& from, const FloorPoint& goal,
                           const Mark& mark) const {
    const std::vector<std::string> doors = closed_doors_between(building_, from, goal);
    std::string why = "; is every door on the way at least 0.9 m wide, and nothing in it?";
    if (!doors.empty())
      why = ": " + open_them(doors);
    else if (from.storey != goal.storey)
      why = ", since it is on storey '" + building_.storeys[static_cast<std::size_t>(goal.storey)].id +
            "': " + stairs_at_fault();
    throw InputError(mark, "room '" + name + "' cannot be reached from " + text(from.p_W) + why);
  }

  /// Why the stairs of the building do not help.
  [[nodiscard]] std::string stairs_at_fault() const {
    std::string list;
    for (const sim::StairWay& way : space_.stairs())
      if (!way.fault.empty()) list += (list.empty() ? "" : ", ") + ("stair '" + way.id + "' " + way.fault);
    if (!list.empty()) return list;
    return building_.stairs.empty() ? "the building has no stairs" : "no stair that can be walked to leads there";
  }

  /// Indices of the rooms that `all` means, without the one of the start.
  [[nodiscard]] std::vector<int> rooms_of_all(const Route& route, const FloorPoint& at) const {
    const std::vector<int> storeys =
        route.storeys == RouteStoreys::all ? space_.reachable_storeys(at) : std::vector<int>{at.storey};
    std::vector<int> found;
    for (std::size_t i = 0; i < building_.rooms.size(); ++i) {
      const bim::Room& candidate = building_.rooms[i];
      if (!std::binary_search(storeys.begin(), storeys.end(), candidate.storey)) continue;
      if (candidate.storey == at.storey && contains(candidate.polygon, at.p_W)) continue;
      if (place_in(candidate.storey, candidate.polygon)) found.push_back(static_cast<int>(i));
    }
    return found;
  }

  /// Index into `left` of the room nearest by the way to walk (ties: lower index): of the storey the robot is on, and
  /// of others when none of those can be reached.
  [[nodiscard]] std::optional<std::size_t> nearest_room(const std::vector<int>& left, const FloorPoint& at,
                                                        Path& way) const {
    for (const bool here : {true, false}) {
      std::optional<std::size_t> best;
      for (std::size_t i = 0; i < left.size(); ++i) {
        if ((room(left[i]).storey == at.storey) != here) continue;
        Path leg = space_.path(at, target(left[i], marks_.route));
        if (leg.empty() || (best && sim::length(leg) >= sim::length(way))) continue;
        best = i;
        way = std::move(leg);
      }
      if (best) return best;
    }
    return std::nullopt;
  }

  /// Nearest room first, each storey before the next, and back to the room of the start; rooms out of reach are left
  /// out, and where that leaves none the robot walks round where it is.
  void walk_all(const Route& route, FloorPoint at, RoutePlan& plan) const {
    const FloorPoint start = at;
    std::vector<int> left = rooms_of_all(route, at);
    Path way;
    while (const std::optional<std::size_t> next = nearest_room(left, at, way)) {
      append(way, plan);
      plan.rooms.push_back(room(left[*next]).id);
      at = target(left[*next], marks_.route);
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(*next));
    }
    if (plan.rooms.empty()) {
      refuse_when_shut_in(left, start);
      return walk_round(route.loop, plan);
    }
    return_home(start, at, plan);
    for (int lap = 1; lap < route.loop; ++lap)
      for (const std::string& name : std::vector<std::string>(plan.rooms)) walk_to(name, marks_.route, at, plan);
  }

  /// A walk of no steps is refused where closed doors are the reason.
  void refuse_when_shut_in(const std::vector<int>& others, const FloorPoint& start) const {
    for (const int other : others) {
      const FloorPoint goal = target(other, marks_.route);
      if (!closed_doors_between(building_, start, goal).empty()) refuse(room(other).id, start, goal, marks_.route);
    }
  }

  void return_home(const FloorPoint& start, FloorPoint& at, RoutePlan& plan) const {
    for (const bim::Room& home : building_.rooms) {
      if (home.storey != start.storey || !contains(home.polygon, start.p_W)) continue;
      if (!place_in(home.storey, home.polygon)) return;
      walk_to(home.id, marks_.route, at, plan);
      plan.rooms.push_back(home.id);
      return;
    }
  }

  /// Both ends of the room along its longer side, and between them.
  void shuttle(const Route& route, FloorPoint at, RoutePlan& plan) const {
    const int index = find_room(building_, *route.shuttle, marks_.route);
    const FloorPoint middle = target(index, marks_.route);
    const Eigen::Vector2d axis = long_axis(room(index).polygon);
    const std::array<FloorPoint, 2> ends = {last_free(middle, axis), last_free(middle, -axis)};
    if ((ends[0].p_W - ends[1].p_W).norm() < shuttle_min_m)
      throw InputError(marks_.route, "room '" + room(index).id + "' is too small to walk to and fro in: " +
                                         format_number(round_coordinate((ends[0].p_W - ends[1].p_W).norm())) +
                                         " m; it must be at least " + format_number(shuttle_min_m) + " m");
    for (int i = 0; i < 2 * route.times; ++i) {
      const FloorPoint& end = ends[static_cast<std::size_t>(i % 2)];
      const Path leg = space_.path(at, end);
      if (leg.empty()) refuse(*route.shuttle, at, middle, marks_.route);
      append(leg, plan);
      at = end;
    }
  }

  [[nodiscard]] static Eigen::Vector2d long_axis(const Polygon2& polygon) {
    Eigen::Vector2d axis = Eigen::Vector2d::UnitX();
    double best = 0.0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Eigen::Vector2d edge = polygon[(i + 1) % polygon.size()] - polygon[i];
      if (edge.norm() <= best) continue;
      best = edge.norm();
      axis = edge / best;
    }
    return axis;
  }

  [[nodiscard]] FloorPoint last_free(const FloorPoint& from, const Eigen::Vector2d& direction) const {
    constexpr double step = 0.05;
    const sim::ClearanceMap& space = space_.storey(from.storey);
    int i = 0;
    while (space.free(from.p_W + (i + 1) * step * direction)) ++i;
    return {from.storey, from.p_W + i * step * direction};
  }

  const bim::Building& building_;
  int storey_;
  const RouteMarks& marks_;
  sim::MultiStoreyPlanner space_;
};

int start_storey(const bim::Building& building, const Start& start, const RouteMarks& marks) {
  if (start.room) return building.rooms[static_cast<std::size_t>(find_room(building, *start.room, marks.start))].storey;
  if (start.storey) return find_storey(building, *start.storey, marks.start);
  if (building.rooms.empty() && !building.storeys.empty()) return 0;
  const int lowest = lowest_habitable_storey(building);
  if (lowest < 0 && !start.at)
    throw InputError(marks.start,
                     "the building has no room the robot fits in; give a start: {storey: ..., at: [x, y]}");
  return std::max(lowest, 0);
}

double first_heading_deg(const Path& waypoints) {
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    const Eigen::Vector2d leg = (waypoints[i].p_W - waypoints[0].p_W).head<2>();
    if (leg.norm() > 0.1) return round_coordinate(std::atan2(leg.y(), leg.x()) * 180.0 / std::numbers::pi);
  }
  return 0.0;
}

}  // namespace

int lowest_habitable_storey(const bim::Building& building) {
  std::vector<int> order;
  for (std::size_t i = 0; i < building.storeys.size(); ++i) order.push_back(static_cast<int>(i));
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return building.storeys[static_cast<std::size_t>(a)].elevation_m <
           building.storeys[static_cast<std::size_t>(b)].elevation_m;
  });
  for (const int storey : order) {
    std::optional<sim::ClearanceMap> space;
    for (const bim::Room& room : building.rooms) {
      if (room.storey != storey) continue;
      if (!space) space.emplace(building, storey);
      if (!space->room_target(room.polygon).empty()) return storey;
    }
  }
  return -1;
}

bool on_a_stair(const bim::Building& building, int storey, const Eigen::Vector2d& p_W) {
  return std::any_of(building.stairs.begin(), building.stairs.end(), [&](const bim::Stair& stair) {
    return (stair.from == storey || stair.to == storey) && on_stair(stair, p_W);
  });
}

bool in_a_doorway(const bim::Building& building, int storey, const Eigen::Vector2d& p_W) {
  return std::any_of(building.openings.begin(), building.openings.end(), [&](const bim::Opening& opening) {
    if (opening.wall < 0 || opening.kind == bim::OpeningKind::window || opening.leaf == bim::Leaf::closed) return false;
    const bim::Wall& wall = building.walls[static_cast<std::size_t>(opening.wall)];
    const double along = (p_W - wall.a).dot(wall.direction());
    return wall.storey == storey && in_body(wall, p_W) && std::abs(along - opening.s_m) <= 0.5 * opening.width_m;
  });
}

int storey_of(const bim::Building& building, const std::optional<std::string>& name, const Mark& mark) {
  Start start;
  start.storey = name;
  return start_storey(building, start, {mark, {}, {}});
}

RoutePlan plan_route(const bim::Building& building, const Start& start, const Route& route, const RouteMarks& marks) {
  RoutePlan plan;
  plan.storey = start_storey(building, start, marks);
  const Planner planner(building, plan.storey, marks);
  plan.start_W = planner.place(start);
  planner.walk(route, plan);
  plan.length_m = sim::length(plan.waypoints);
  plan.stairs_m = sim::length_on_stairs(plan.waypoints);
  plan.yaw_deg = start.yaw_deg ? *start.yaw_deg : first_heading_deg(plan.waypoints);
  return plan;
}

}  // namespace plumbline::scenarios
