// SPDX-License-Identifier: Apache-2.0
#include "scenarios/route_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "scenarios/closed_doors.h"
#include "scenarios/roam.h"
#include "sim/route/route.h"

namespace plumbline::scenarios {

namespace {

using Path = std::vector<Eigen::Vector2d>;

constexpr std::string_view all_rooms = "all";
/// Start points and headings are written with this many decimals (0.1 mm), so that the resolved file reads well.
constexpr double coordinate_steps = 1e4;

double round_coordinate(double x) { return std::round(x * coordinate_steps) / coordinate_steps; }

std::string text(const Eigen::Vector2d& p) { return "[" + format_number(p.x()) + ", " + format_number(p.y()) + "]"; }

double length(const Path& path) {
  double sum = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += (path[i] - path[i - 1]).norm();
  return sum;
}

std::string unknown(const std::string& kind, const std::string& name, const std::vector<std::string>& known) {
  const std::string close = did_you_mean(name, known);
  if (!close.empty()) return "unknown " + kind + " '" + name + "'; did you mean '" + close + "'?";
  std::string message = "unknown " + kind + " '" + name + "'; the building has:";
  for (const std::string& other : known) message += " " + other;
  return message;
}

/// In the plane; openings do not count, since nobody starts in a doorway.
bool in_body(const bim::Wall& wall, const Eigen::Vector2d& p) {
  const double along = (p - wall.a).dot(wall.direction());
  const double across = (p - wall.a).dot(wall.left());
  return along >= 0.0 && along <= wall.length() && across >= wall.offset_m &&
         across <= wall.offset_m + wall.thickness_m;
}

int find_storey(const bim::Building& building, const std::string& name, const Mark& mark) {
  std::vector<std::string> known;
  for (std::size_t i = 0; i < building.storeys.size(); ++i) {
    if (building.storeys[i].id == name || building.storeys[i].name == name) return static_cast<int>(i);
    known.push_back(building.storeys[i].name.empty() ? building.storeys[i].id : building.storeys[i].name);
  }
  throw InputError(mark, unknown("storey", name, known));
}

int find_room(const bim::Building& building, const std::string& name, const Mark& mark) {
  if (building.rooms.empty())
    throw InputError(mark, "there is no room '" + name + "': no rooms are known in this building; " +
                               "give a start by {at: [x, y]} and the route {rooms: all}");
  std::vector<std::string> known;
  for (std::size_t i = 0; i < building.rooms.size(); ++i) {
    if (building.rooms[i].id == name || building.rooms[i].name == name) return static_cast<int>(i);
    known.push_back(building.rooms[i].id);
  }
  throw InputError(mark, unknown("room", name, known));
}

/// Plans on one storey of a building, with the place in the file to blame.
class Planner {
 public:
  Planner(const bim::Building& building, int storey, const RouteMarks& marks)
      : building_(building), storey_(storey), marks_(marks), space_(building, storey) {}

  [[nodiscard]] Eigen::Vector2d place(const Start& start) const {
    if (start.at) return check_start(*start.at);
    if (!start.room && building_.rooms.empty()) return freest_place();
    return target(start.room ? find_room(building_, *start.room, marks_.start) : largest_room(), marks_.start);
  }

  /// Room indices in the order of the walk and the waypoints through them.
  void walk(const Route& route, RoutePlan& plan) const {
    plan.waypoints = {plan.start_W};
    if (route.shuttle) return shuttle(route, plan);
    const bool all = route.rooms.size() == 1 && route.rooms.front() == all_rooms;
    if (all && building_.rooms.empty()) return walk_round(route.loop, plan);
    if (all) return walk_all(route.loop, plan);
    for (int lap = 0; lap < route.loop; ++lap)
      for (std::size_t i = 0; i < route.rooms.size(); ++i) walk_to(route.rooms[i], mark_of(i), plan);
    plan.rooms = route.rooms;
  }

 private:
  [[nodiscard]] const Mark& mark_of(std::size_t i) const {
    return i < marks_.rooms.size() ? marks_.rooms[i] : marks_.route;
  }

  [[nodiscard]] Eigen::Vector2d check_start(const Eigen::Vector2d& at) const {
    for (const bim::Wall& wall : building_.walls)
      if (wall.storey == storey_ && in_body(wall, at))
        throw InputError(marks_.start,
                         "the start " + text(at) + " is inside a wall ('" + wall.id + "'); it must be in a room");
    const auto in_room = [&](const bim::Room& room) { return room.storey == storey_ && contains(room.polygon, at); };
    const bool has_rooms = std::any_of(building_.rooms.begin(), building_.rooms.end(),
                                       [&](const bim::Room& room) { return room.storey == storey_; });
    if (has_rooms && std::none_of(building_.rooms.begin(), building_.rooms.end(), in_room))
      throw InputError(marks_.start, "the start " + text(at) + " is outside every room; it must be in a room");
    if (!space_.free(at))
      throw InputError(marks_.start, "the start " + text(at) + " is in or too near to a wall or another thing (" +
                                         format_number(round_coordinate(space_.clearance(at))) +
                                         " m clear); the robot needs more room around it");
    return at;
  }

  /// Box around the floor of the storey.
  [[nodiscard]] Eigen::AlignedBox2d floor_box() const {
    Eigen::AlignedBox2d box;
    for (const bim::Slab& slab : building_.slabs)
      for (const Eigen::Vector2d& p : slab.polygon.outer)
        if (slab.storey == storey_) box.extend(p);
    return box;
  }

  /// Where no rooms are known.
  [[nodiscard]] Eigen::Vector2d freest_place() const {
    const Eigen::AlignedBox2d box = floor_box();
    Path found;
    if (!box.isEmpty()) {
      const Eigen::Vector2d low = box.min(), high = box.max();
      found = space_.room_target({low, {high.x(), low.y()}, high, {low.x(), high.y()}});
    }
    if (found.empty()) throw InputError(marks_.start, "there is no place on the floor where the robot fits");
    return {round_coordinate(found.front().x()), round_coordinate(found.front().y())};
  }

  void walk_round(int laps, RoutePlan& plan) const {
    const Eigen::AlignedBox2d box = floor_box();
    const Path round = box.isEmpty() ? Path{} : roam(space_, box, plan.start_W);
    for (int lap = 0; lap < laps; ++lap) append(round, plan);
    plan.rooms = {std::string(all_rooms)};
  }

  /// Rooms of this storey that can be stood in, largest first (ties: lower index).
  [[nodiscard]] int largest_room() const {
    int best = -1;
    double best_area = 0.0;
    for (std::size_t i = 0; i < building_.rooms.size(); ++i) {
      const bim::Room& room = building_.rooms[i];
      const double area = std::abs(signed_area(room.polygon));
      if (room.storey != storey_ || area <= best_area || space_.room_target(room.polygon).empty()) continue;
      best = static_cast<int>(i);
      best_area = area;
    }
    if (best < 0) throw InputError(marks_.start, "no room to start in; give a start: {storey: ..., at: [x, y]}");
    return best;
  }

  [[nodiscard]] Eigen::Vector2d target(int room, const Mark& mark) const {
    const bim::Room& r = building_.rooms[static_cast<std::size_t>(room)];
    if (r.storey != storey_)
      throw InputError(mark, "room '" + r.id + "' is on another storey; this version walks on one");
    const Path found = space_.room_target(r.polygon);
    if (found.empty()) throw InputError(mark, "room '" + r.id + "' has no place where the robot fits");
    return {round_coordinate(found.front().x()), round_coordinate(found.front().y())};
  }

  [[nodiscard]] Path path(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
    if ((b - a).norm() < 1e-9) return {a};
    return space_.path(a, b);
  }

  static void append(const Path& path, RoutePlan& plan) {
    plan.waypoints.insert(plan.waypoints.end(), path.begin() + (path.empty() ? 0 : 1), path.end());
  }

  void walk_to(const std::string& room, const Mark& mark, RoutePlan& plan) const {
    const Eigen::Vector2d goal = target(find_room(building_, room, mark), mark);
    const Path leg = path(plan.waypoints.back(), goal);
    if (leg.empty()) refuse(room, plan.waypoints.back(), goal, mark);
    append(leg, plan);
  }

  [[noreturn]] void refuse(const std::string& room, const Eigen::Vector2d& from, const Eigen::Vector2d& goal,
                           const Mark& mark) const {
    const std::vector<std::string> doors = closed_doors_between(building_, storey_, from, goal);
    const std::string why =
        doors.empty() ? "; is every door on the way at least 0.9 m wide, and nothing in it?" : ": " + open_them(doors);
    throw InputError(mark, "room '" + room + "' cannot be reached from " + text(from) + why);
  }

  /// Nearest room first, by the way to walk (ties: lower index), and back to the room of the start; rooms out of
  /// reach are left out.
  void walk_all(int laps, RoutePlan& plan) const {
    std::vector<int> left;
    for (std::size_t i = 0; i < building_.rooms.size(); ++i) {
      const bim::Room& room = building_.rooms[i];
      if (room.storey != storey_ || contains(room.polygon, plan.start_W)) continue;
      if (!space_.room_target(room.polygon).empty()) left.push_back(static_cast<int>(i));
    }
    while (!left.empty()) {
      std::optional<std::size_t> best;
      Path best_path;
      for (std::size_t i = 0; i < left.size(); ++i) {
        Path leg = path(plan.waypoints.back(), target(left[i], marks_.route));
        if (leg.empty() || (best && length(leg) >= length(best_path))) continue;
        best = i;
        best_path = std::move(leg);
      }
      if (!best) break;
      append(best_path, plan);
      plan.rooms.push_back(building_.rooms[static_cast<std::size_t>(left[*best])].id);
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(*best));
    }
    if (plan.rooms.empty()) refuse_when_shut_in(left, plan);
    if (!plan.rooms.empty()) return_home(plan);
    for (int lap = 1; lap < laps; ++lap)
      for (const std::string& room : std::vector<std::string>(plan.rooms)) walk_to(room, marks_.route, plan);
  }

  /// A walk of no steps is refused where closed doors are the reason.
  void refuse_when_shut_in(const std::vector<int>& others, const RoutePlan& plan) const {
    for (const int room : others)
      if (!closed_doors_between(building_, storey_, plan.start_W, target(room, marks_.route)).empty())
        refuse(building_.rooms[static_cast<std::size_t>(room)].id, plan.start_W, target(room, marks_.route),
               marks_.route);
  }

  void return_home(RoutePlan& plan) const {
    for (const bim::Room& room : building_.rooms) {
      if (room.storey != storey_ || !contains(room.polygon, plan.start_W)) continue;
      if (space_.room_target(room.polygon).empty()) return;
      walk_to(room.id, marks_.route, plan);
      plan.rooms.push_back(room.id);
      return;
    }
  }

  /// Both ends of the room along its longer side, and between them.
  void shuttle(const Route& route, RoutePlan& plan) const {
    const int index = find_room(building_, *route.shuttle, marks_.route);
    const Eigen::Vector2d middle = target(index, marks_.route);
    const Eigen::Vector2d axis = long_axis(building_.rooms[static_cast<std::size_t>(index)].polygon);
    const Path ends = {last_free(middle, axis), last_free(middle, -axis)};
    for (int i = 0; i < 2 * route.times; ++i) {
      const Path leg = path(plan.waypoints.back(), ends[static_cast<std::size_t>(i % 2)]);
      if (leg.empty()) refuse(*route.shuttle, plan.waypoints.back(), middle, marks_.route);
      append(leg, plan);
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

  [[nodiscard]] Eigen::Vector2d last_free(const Eigen::Vector2d& from, const Eigen::Vector2d& direction) const {
    constexpr double step = 0.05;
    int i = 0;
    while (space_.free(from + (i + 1) * step * direction)) ++i;
    return from + i * step * direction;
  }

  const bim::Building& building_;
  int storey_;
  const RouteMarks& marks_;
  sim::FreeSpace space_;
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
    const Eigen::Vector2d leg = waypoints[i] - waypoints[0];
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
    std::optional<sim::FreeSpace> space;
    for (const bim::Room& room : building.rooms) {
      if (room.storey != storey) continue;
      if (!space) space.emplace(building, storey);
      if (!space->room_target(room.polygon).empty()) return storey;
    }
  }
  return -1;
}

RoutePlan plan_route(const bim::Building& building, const Start& start, const Route& route, const RouteMarks& marks) {
  RoutePlan plan;
  plan.storey = start_storey(building, start, marks);
  const Planner planner(building, plan.storey, marks);
  plan.start_W = planner.place(start);
  planner.walk(route, plan);
  plan.length_m = length(plan.waypoints);
  plan.yaw_deg = start.yaw_deg ? *start.yaw_deg : first_heading_deg(plan.waypoints);
  return plan;
}

}  // namespace plumbline::scenarios
