// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/route_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "bim/model/odd_size.h"
#include "scenarios/spec/closed_doors.h"
#include "scenarios/spec/entered_room.h"
#include "scenarios/spec/exploration_route.h"
#include "scenarios/spec/named_places.h"
#include "scenarios/spec/room_places.h"
#include "scenarios/spec/start_check.h"
#include "scenarios/spec/storeys_out_of_reach.h"
#include "scenarios/spec/tour.h"
#include "scenarios/spec/why_no_way.h"
#include "sim/route/neighbour_ways.h"

namespace plumbline::scenarios {

namespace {

using sim::FloorPoint;
using Path = std::vector<sim::Waypoint>;

constexpr std::string_view all_rooms = "all";
constexpr double shuttle_min_m = 0.5;  ///< of a way worth walking to and fro
constexpr double walk_min_m = 1.0;     ///< no shorter walk through all rooms, or round the floor, is one

double round_coordinate(double x) { return rounded({x, 0.0}).x(); }

/// Plans from a start on one storey of a building, with the place in the file to blame.
class Planner {
 public:
  Planner(const sim::MultiStoreyPlanner& space, const RoomPlaces& places, int storey, const RouteMarks& marks,
          std::optional<double> all_longest_m)
      : building_(space.building()),
        storey_(storey),
        marks_(marks),
        all_longest_m_(all_longest_m),
        space_(space),
        places_(places) {}

  [[nodiscard]] Eigen::Vector2d place(const Start& start) const {
    if (start.at) {
      check_start(space_, storey_, *start.at, marks_.start);
      return *start.at;
    }
    if (!start.room && building_.rooms.empty()) return freest_place();
    return target(start.room ? find_room(building_, *start.room, marks_.start) : largest_room(), marks_.start).p_W;
  }

  /// Room indices in the order of the walk and the waypoints through them.
  void walk(const Route& route, RoutePlan& plan) const {
    plan.waypoints = sim::on_floor({plan.start_W}, elevation(storey_) + space_.storey(storey_).height(plan.start_W));
    FloorPoint at{storey_, plan.start_W};
    if (route.shuttle) return shuttle(route, at, plan);
    const bool all = route.rooms.size() == 1 && route.rooms.front() == all_rooms;
    if (all && route.storeys == RouteStoreys::all) plan.storeys_out_of_reach = storeys_out_of_reach(space_, at);
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

  /// Where no rooms are known.
  [[nodiscard]] Eigen::Vector2d freest_place() const {
    const std::vector<Eigen::Vector2d> found = space_.storey(storey_).open_target();
    if (found.empty())
      throw InputError(marks_.start,
                       "there is no place on the floor where the robot fits, and no rooms are known; give a "
                       "start: {storey: ..., at: [x, y]} from where it can walk");
    return rounded(found.front());
  }

  /// Where no rooms are known, or none but the one of the start is in reach.
  void walk_round(int laps, RoutePlan& plan) const {
    const Eigen::AlignedBox2d box = floor_box(building_, storey_);
    const sim::ClearanceMap& space = space_.storey(storey_);
    Path round;
    for (const ExplorationConfig& config : {ExplorationConfig(), small_floor_exploration()})
      if (!box.isEmpty() && is_too_short(round))
        round = sim::with_clearance(space, exploration_route(space, box, plan.start_W, config),
                                    plan.waypoints.front().p_W.z());
    if (is_too_short(round))
      throw InputError(marks_.route, "there is nowhere to walk to from " + point_text(plan.start_W) +
                                         why_nowhere_to_walk(space_, {storey_, plan.start_W}));
    for (int lap = 0; lap < laps; ++lap) append(round, plan);
    plan.rooms = {std::string(all_rooms)};
  }

  [[nodiscard]] int largest_room() const {
    const int room = places_.start_on(storey_).room;
    if (room < 0) throw InputError(marks_.start, "no room to start in; give a start: {storey: ..., at: [x, y]}");
    return room;
  }

  [[nodiscard]] FloorPoint target(int index, const Mark& mark) const {
    const std::optional<FloorPoint>& found = places_.of(index);
    if (!found)
      throw InputError(mark, "room " + quoted(room(index)) + " has no place where the robot can turn round; it needs " +
                                 format_number(2.0 * sim::RouteConfig().turn_m) + " m");
    return *found;
  }

  [[nodiscard]] static bool is_too_short(const Path& path) {
    constexpr double rounding_m = 1e-6;
    return sim::length(path) < walk_min_m - rounding_m;
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
    throw InputError(mark, "room " + quoted(room(find_room(building_, name, mark))) + " cannot be reached from " +
                               point_text(from.p_W) + why_no_way(space_, from, goal));
  }

  /// Indices of the rooms that `all` means, without the one of the start.
  [[nodiscard]] std::vector<int> rooms_of_all(const Route& route, const FloorPoint& at) const {
    const std::vector<int> storeys =
        route.storeys == RouteStoreys::all ? space_.reachable_storeys(at) : std::vector<int>{at.storey};
    std::vector<int> found;
    for (std::size_t i = 0; i < building_.rooms.size(); ++i) {
      const bim::Room& candidate = building_.rooms[i];
      if (!std::binary_search(storeys.begin(), storeys.end(), candidate.storey)) continue;
      if (candidate.storey == at.storey && candidate.contains(at.p_W)) continue;
      if (places_.of(static_cast<int>(i))) found.push_back(static_cast<int>(i));
    }
    return found;
  }

  /// Index into `left` of the room nearest by the way to walk (ties: lower index): of the storey the robot is on, and
  /// of others when none of those can be reached. Takes out of `left` what cannot be reached.
  [[nodiscard]] std::optional<std::size_t> nearest_room(std::vector<int>& left, const FloorPoint& at, Path& way) const {
    for (const bool here : {true, false}) {
      std::optional<int> best;
      for (const int candidate : in_straight_order(left, at, here)) {
        const FloorPoint goal = target(candidate, marks_.route);
        if (best && (goal.p_W - at.p_W).norm() > sim::length(way)) break;  // no way is shorter than the straight line
        Path leg = space_.path(at, goal);
        if (leg.empty()) {
          std::erase(left, candidate);
          continue;
        }
        const double length = sim::length(leg);
        if (best && (length > sim::length(way) || (length == sim::length(way) && candidate > *best))) continue;
        best = candidate;
        way = std::move(leg);
      }
      if (best) return static_cast<std::size_t>(std::find(left.begin(), left.end(), *best) - left.begin());
    }
    return std::nullopt;
  }

  /// Rooms on the robot's storey, or on others, by the straight line to them.
  [[nodiscard]] std::vector<int> in_straight_order(const std::vector<int>& rooms, const FloorPoint& at,
                                                   bool here) const {
    std::vector<std::pair<double, int>> order;
    for (const int index : rooms)
      if ((room(index).storey == at.storey) == here)
        order.emplace_back((target(index, marks_.route).p_W - at.p_W).norm(), index);
    std::sort(order.begin(), order.end());
    std::vector<int> sorted;
    for (const auto& [distance, index] : order) sorted.push_back(index);
    return sorted;
  }

  /// Nearest room first, each storey before the next, and back to the room of the start; rooms out of reach are left
  /// out, and where that leaves none the robot walks round where it is.
  void walk_all(const Route& route, FloorPoint at, RoutePlan& plan) const {
    const FloorPoint start = at;
    const std::vector<int> others = rooms_of_all(route, at);
    if (!walk_nearest_first(others, at, plan)) walk_tour(others, start, at, plan);
    if (!plan.rooms.empty()) return_home(start, at, plan);
    if (is_too_short(plan.waypoints)) {  // of rooms whose freest places lie at a corner that they share
      plan.waypoints.resize(1);
      plan.rooms.clear();
      refuse_when_shut_in(others, start);
      return walk_round(route.loop, plan);
    }
    for (int lap = 1; lap < route.loop; ++lap)
      for (const std::string& name : std::vector<std::string>(plan.rooms)) walk_to(name, marks_.route, at, plan);
  }

  /// False, with the walk as it was, where it would become longer than it may.
  [[nodiscard]] bool walk_nearest_first(std::vector<int> left, FloorPoint& at, RoutePlan& plan) const {
    const RoutePlan before = plan;
    const FloorPoint start = at;
    Path way;
    double length = 0.0;
    while (const std::optional<std::size_t> next = nearest_room(left, at, way)) {
      append(way, plan);
      length += sim::length(way);
      plan.rooms.push_back(room(left[*next]).id);
      at = target(left[*next], marks_.route);
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(*next));
      if (!all_longest_m_ || length + (at.p_W - start.p_W).norm() <= *all_longest_m_) continue;
      plan = before;
      at = start;
      return false;
    }
    if (!all_longest_m_ || length + sim::length(space_.path(at, start)) <= *all_longest_m_) return true;
    plan = before;
    at = start;
    return false;
  }

  /// Through as many of the rooms on the start's storey as the longest walk allows, far ends first.
  void walk_tour(const std::vector<int>& others, const FloorPoint& start, FloorPoint& at, RoutePlan& plan) const {
    std::vector<Eigen::Vector2d> places = {start.p_W};
    std::vector<int> rooms = {-1};
    for (const int other : others) {
      const FloorPoint goal = target(other, marks_.route);
      if (goal.storey != start.storey) continue;
      places.push_back(goal.p_W);
      rooms.push_back(other);
    }
    const auto ways = sim::neighbour_ways(space_.storey(start.storey), places);
    // Ways from place to place are longer than the walk, which does not pass the middle of every room between.
    for (const double longer : {1.6, 1.45, 1.3, 1.15, 1.0}) {
      const RoutePlan before = plan;
      at = start;
      for (const std::size_t next : tour(places.size(), ways, longer * *all_longest_m_)) {
        walk_to(room(rooms[next]).id, marks_.route, at, plan);
        plan.rooms.push_back(room(rooms[next]).id);
      }
      if (longer <= 1.0 || sim::length(plan.waypoints) + sim::length(space_.path(at, start)) <= *all_longest_m_) return;
      plan = before;
    }
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
      if (home.storey != start.storey || !home.contains(start.p_W)) continue;
      if (!places_.of(static_cast<int>(&home - building_.rooms.data()))) return;
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
    const std::array<FloorPoint, 2> ends = {last_free(index, middle, axis), last_free(index, middle, -axis)};
    if ((ends[0].p_W - ends[1].p_W).norm() < shuttle_min_m)
      throw InputError(marks_.route, "room " + quoted(room(index)) + " is too small to walk to and fro in: " +
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

  /// The last place of the room in a direction before the robot would not fit: a door in its end wall leads out of it.
  [[nodiscard]] FloorPoint last_free(int index, const FloorPoint& from, const Eigen::Vector2d& direction) const {
    constexpr double step = 0.05;
    const sim::ClearanceMap& space = space_.storey(from.storey);
    const auto at = [&](int i) -> Eigen::Vector2d { return from.p_W + i * step * direction; };
    int i = 0;
    while (room(index).contains(at(i + 1)) && space.free(at(i + 1))) ++i;
    while (i > 0 && space_.path({from.storey, at(i)}, from).empty()) --i;
    return {from.storey, at(i)};
  }

  const bim::Building& building_;
  int storey_;
  const RouteMarks& marks_;
  std::optional<double> all_longest_m_;
  const sim::MultiStoreyPlanner& space_;
  const RoomPlaces& places_;
};

/// A size that explains why nothing fits, as the beginning of a sentence.
std::string odd_size_of(const bim::Building& building) {
  const std::string odd = bim::odd_size(building);
  return odd.empty() ? odd : odd + " ";
}

int start_storey(const bim::Building& building, const RoomPlaces& places, const Start& start, const RouteMarks& marks) {
  if (start.room) return building.rooms[static_cast<std::size_t>(find_room(building, *start.room, marks.start))].storey;
  if (start.storey) return find_storey(building, *start.storey, marks.start);
  if (building.rooms.empty() && !building.storeys.empty()) return 0;
  const int lowest = places.start_storey();
  if (lowest < 0 && !start.at)
    throw InputError(marks.start, odd_size_of(building) + "the building has no room the robot fits in (" +
                                      places.why_nowhere() + "); give a start: {storey: ..., at: [x, y]}");
  return std::max(lowest, 0);
}

/// Rooms that a walk names and does not enter.
std::vector<int> rooms_passed(const sim::MultiStoreyPlanner& space, const RoutePlan& plan) {
  std::vector<int> passed;
  for (std::size_t i = 0; i < space.building().rooms.size(); ++i)
    if (std::find(plan.rooms.begin(), plan.rooms.end(), space.building().rooms[i].id) != plan.rooms.end() &&
        !enters_room(space, plan.waypoints, static_cast<int>(i)))
      passed.push_back(static_cast<int>(i));
  return passed;
}

double first_heading_deg(const Path& waypoints) {
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    const Eigen::Vector2d leg = (waypoints[i].p_W - waypoints[0].p_W).head<2>();
    if (leg.norm() > 0.1) return round_coordinate(std::atan2(leg.y(), leg.x()) * 180.0 / std::numbers::pi);
  }
  return 0.0;
}

}  // namespace

int storey_of(const bim::Building& building, const std::optional<std::string>& name, const Mark& mark) {
  Start start;
  start.storey = name;
  const sim::MultiStoreyPlanner space(building);
  return start_storey(building, RoomPlaces(building, space), start, {mark, {}, {}});
}

RoutePlan plan_route(const sim::MultiStoreyPlanner& space, const Start& start, const Route& route,
                     const RouteMarks& marks, std::optional<double> all_longest_m) {
  RoutePlan begun;
  const RoomPlaces places(space.building(), space);
  begun.storey = start_storey(space.building(), places, start, marks);
  begun.start_W = Planner(space, places, begun.storey, marks, all_longest_m).place(start);
  const auto walk = [&](const std::vector<int>& inside) {
    RoutePlan plan = begun;
    const RoomPlaces in_reach(space.building(), space, FloorPoint{plan.storey, plan.start_W}, inside);
    Planner(space, in_reach, plan.storey, marks, all_longest_m).walk(route, plan);
    return plan;
  };
  RoutePlan plan = walk({});
  // A walk through all rooms that only passes some, at an open side where their floor is freest, goes into them.
  if (const std::vector<int> passed = rooms_passed(space, plan);
      route.rooms == std::vector<std::string>{std::string(all_rooms)} && !passed.empty()) {
    RoutePlan inside = walk(passed);
    if (inside.rooms.size() >= plan.rooms.size() && rooms_passed(space, inside).size() < passed.size())
      plan = std::move(inside);
  }
  plan.length_m = sim::length(plan.waypoints);
  plan.stairs_m = sim::length_on_stairs(plan.waypoints);
  plan.yaw_deg = start.yaw_deg ? *start.yaw_deg : first_heading_deg(plan.waypoints);
  return plan;
}

RoutePlan plan_route(const bim::Building& building, const Start& start, const Route& route, const RouteMarks& marks) {
  return plan_route(sim::MultiStoreyPlanner(building), start, route, marks);
}

}  // namespace plumbline::scenarios
