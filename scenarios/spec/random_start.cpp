// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/random_start.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "bim/random/stream.h"
#include "scenarios/spec/named_places.h"
#include "scenarios/spec/room_places.h"
#include "scenarios/spec/start_check.h"
#include "sim/route/multi_storey_planner.h"

namespace plumbline::scenarios {

namespace {

constexpr double cell_m = 0.1;            ///< spacing of the places drawn from
constexpr double coordinate_steps = 1e4;  ///< written with four decimals
constexpr std::uint32_t start_lane = 0;   ///< of Stream "scenario.start"
constexpr std::uint32_t heading_lane = 1;
constexpr std::uint32_t route_lane = 2;
constexpr std::uint32_t passage_lane = 3;

double on_grid(double x) { return std::round(x * coordinate_steps) / coordinate_steps; }

/// A room the robot can stand in, with its places.
struct OpenRoom {
  std::string id;
  Eigen::Vector2d middle_W = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector2d> places_W;
};

std::vector<Eigen::Vector2d> places_in(const bim::Building& building, const bim::Room& room,
                                       const sim::ClearanceMap& space) {
  const Polygon2& polygon = room.polygon;
  const double turn_m = sim::RouteConfig().turn_m;  // a drawn heading is seldom that of the first leg
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : polygon) box.extend(p);
  std::vector<Eigen::Vector2d> places;
  for (double x = box.min().x() + 0.5 * cell_m; x < box.max().x(); x += cell_m)
    for (double y = box.min().y() + 0.5 * cell_m; y < box.max().y(); y += cell_m) {
      const Eigen::Vector2d p(on_grid(x), on_grid(y));
      if (room.contains(p) && space.clearance(p) >= turn_m && !on_a_stair(building, room.storey, p))
        places.push_back(p);
    }
  return places;
}

/// Middles of the doorways of a storey that the robot can pass, in the order of the openings.
std::vector<Eigen::Vector2d> doorways_of(const bim::Building& building, int storey, const sim::ClearanceMap& space) {
  std::vector<Eigen::Vector2d> places;
  for (const bim::Opening& opening : building.openings) {
    if (opening.wall < 0) continue;
    const bim::Wall& wall = building.walls[static_cast<std::size_t>(opening.wall)];
    if (wall.storey != storey) continue;
    const Eigen::Vector2d p =
        wall.a + opening.s_m * wall.direction() + (wall.offset_m + 0.5 * wall.thickness_m) * wall.left();
    const Eigen::Vector2d place(on_grid(p.x()), on_grid(p.y()));
    if (in_a_doorway(building, storey, place) && space.free(place)) places.push_back(place);
  }
  return places;
}

/// Where the robot lines up with the stairs that it can climb, on one storey; in the order of the stairs.
std::vector<Eigen::Vector2d> stair_ends_of(const bim::Building& building, int storey,
                                           const sim::MultiStoreyPlanner& space) {
  std::vector<Eigen::Vector2d> places;
  const auto add = [&](const Eigen::Vector3d& point) {
    const Eigen::Vector2d p(on_grid(point.x()), on_grid(point.y()));
    const bool in_room = std::any_of(building.rooms.begin(), building.rooms.end(),
                                     [&](const bim::Room& room) { return room.storey == storey && room.contains(p); });
    if (in_room && space.storey(storey).free(p) && !on_a_stair(building, storey, p)) places.push_back(p);
  };
  for (const sim::StairWay& way : space.stairs()) {
    if (!way.fault.empty() || way.points.empty()) continue;
    if (way.from == storey) add(way.points.front());
    if (way.to == storey) add(way.points.back());
  }
  return places;
}

/// A place to start at.
struct DrawnStart {
  Eigen::Vector2d p_W = Eigen::Vector2d::Zero();
  bool narrow = false;  ///< there may be no room to turn round
};

/// Draws from the rooms of one storey.
class StartSampler {
 public:
  StartSampler(const bim::Building& building, int storey, std::uint64_t seed)
      : storey_(storey), stream_(seed, "scenario.start"), space_(building) {
    for (const bim::Room& room : building.rooms) {
      if (room.storey != storey) continue;
      const std::vector<Eigen::Vector2d> target = space_.storey(storey).room_targets(room);
      if (!target.empty())
        rooms_.push_back({room.id, target.front(), places_in(building, room, space_.storey(storey))});
    }
  }

  /// Tries places until one has a way to another room, if the storey has several, and to all goals; where none has, the
  /// first with a way to another room.
  [[nodiscard]] DrawnStart start(RandomStart how, const bim::Building& building,
                                 const std::vector<sim::FloorPoint>& goals, const Mark& mark) const {
    constexpr std::uint64_t most_tries = 200;
    std::vector<Eigen::Vector2d> passages;
    if (how == RandomStart::anywhere) {
      passages = doorways_of(building, storey_, space_.storey(storey_));
      const std::vector<Eigen::Vector2d> ends = stair_ends_of(building, storey_, space_);
      passages.insert(passages.end(), ends.begin(), ends.end());
    }
    std::optional<DrawnStart> cut_off;
    for (std::uint64_t i = 0; i < most_tries && !rooms_.empty(); ++i) {
      const std::optional<DrawnStart> drawn = draw(how, passages, i);
      if (!drawn) continue;
      if (reaches_all(drawn->p_W, goals)) return *drawn;
      if (!cut_off) cut_off = drawn;
    }
    if (cut_off) return *cut_off;
    throw InputError(mark, "no place to draw on this storey from which another room can be reached");
  }

  [[nodiscard]] double heading_deg() const { return on_grid(360.0 * stream_.uniform(0, heading_lane) - 180.0); }

  [[nodiscard]] std::vector<std::string> route(const Eigen::Vector2d& start, int count, const Mark& mark) const {
    std::vector<std::string> ids;
    if (rooms_.empty()) throw InputError(mark, "no room to draw on this storey");
    if (rooms_.size() == 1)
      throw InputError(mark,
                       "this storey has one room, so there is no other to draw; route: {rooms: all} walks through it");
    std::size_t at = nearest(start);
    Eigen::Vector2d from = start;
    const std::uint64_t most_tries = 200 + static_cast<std::uint64_t>(count);
    for (std::uint64_t i = 0; i < most_tries && ids.size() < static_cast<std::size_t>(count); ++i) {
      const std::size_t next = one_of(rooms_.size(), i, route_lane);
      if (next == at || !reaches(from, rooms_[next])) continue;
      at = next;
      from = rooms_[at].middle_W;
      ids.push_back(rooms_[at].id);
    }
    // Where few of many rooms can be reached, so many draws need not have found enough.
    std::vector<std::size_t> in_reach;
    for (std::size_t i = 0; i < rooms_.size(); ++i)
      if (reaches(start, rooms_[i])) in_reach.push_back(i);
    for (std::uint64_t i = most_tries; ids.size() < static_cast<std::size_t>(count) && !in_reach.empty(); ++i) {
      if (in_reach.size() == 1 && in_reach.front() == at) break;
      const std::size_t next = in_reach[one_of(in_reach.size(), i, route_lane)];
      if (next == at) continue;
      at = next;
      ids.push_back(rooms_[at].id);
    }
    if (ids.empty()) throw InputError(mark, "no room to draw can be reached from the start");
    return ids;
  }

 private:
  [[nodiscard]] std::size_t one_of(std::size_t count, std::uint64_t tick, std::uint32_t lane,
                                   std::uint32_t draw = 0) const {
    const double u = stream_.uniform(tick, lane, draw);
    return std::min(count - 1, static_cast<std::size_t>(u * static_cast<double>(count)));
  }

  /// The i-th try, if it has a way to another room or the storey has only one.
  [[nodiscard]] std::optional<DrawnStart> draw(RandomStart how, const std::vector<Eigen::Vector2d>& passages,
                                               std::uint64_t i) const {
    constexpr double passage_share = 0.25;
    if (!passages.empty() && stream_.uniform(i, passage_lane) < passage_share) {
      const Eigen::Vector2d& p = passages[one_of(passages.size(), i, passage_lane, 1)];
      if (std::count_if(rooms_.begin(), rooms_.end(), [&](const OpenRoom& room) { return reaches(p, room); }) >=
          static_cast<std::ptrdiff_t>(std::min<std::size_t>(2, rooms_.size())))
        return DrawnStart{p, true};
      return std::nullopt;
    }
    const std::size_t room = how == RandomStart::rooms ? one_of(rooms_.size(), i, start_lane) : room_by_area(i);
    const std::vector<Eigen::Vector2d>& places = rooms_[room].places_W;
    if (places.empty()) return std::nullopt;
    const Eigen::Vector2d& p = places[one_of(places.size(), i, start_lane, 1)];
    if (rooms_.size() == 1) return DrawnStart{p, false};
    for (std::size_t other = 0; other < rooms_.size(); ++other)
      if (other != room && reaches(p, rooms_[other])) return DrawnStart{p, false};
    return std::nullopt;
  }

  [[nodiscard]] bool reaches_all(const Eigen::Vector2d& from, const std::vector<sim::FloorPoint>& goals) const {
    return std::all_of(goals.begin(), goals.end(), [&](const sim::FloorPoint& goal) {
      return !space_.path({storey_, from}, goal).empty();
    });
  }

  [[nodiscard]] std::size_t room_by_area(std::uint64_t tick) const {
    std::size_t all = 0;
    for (const OpenRoom& room : rooms_) all += room.places_W.size();
    std::size_t left = one_of(std::max<std::size_t>(all, 1), tick, start_lane);
    for (std::size_t i = 0; i < rooms_.size(); ++i) {
      if (left < rooms_[i].places_W.size()) return i;
      left -= rooms_[i].places_W.size();
    }
    return 0;
  }

  [[nodiscard]] bool reaches(const Eigen::Vector2d& from, const OpenRoom& room) const {
    const int here = space_.storey(storey_).region(from);
    return here >= 0 && here == space_.storey(storey_).region(room.middle_W);
  }

  /// The room the start stands in: where its places come nearest (ties: the first).
  [[nodiscard]] std::size_t nearest(const Eigen::Vector2d& p) const {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < rooms_.size(); ++i)
      for (const Eigen::Vector2d& place : rooms_[i].places_W)
        if ((place - p).squaredNorm() < least) {
          least = (place - p).squaredNorm();
          best = i;
        }
    return best;
  }

  int storey_;
  Stream stream_;
  sim::MultiStoreyPlanner space_;
  std::vector<OpenRoom> rooms_;
};

/// Middles of the rooms that a route names, each once.
std::vector<sim::FloorPoint> goals_of(const bim::Building& building, const Route& route, const RouteMarks& marks) {
  std::vector<int> rooms;
  if (route.shuttle) {
    rooms.push_back(find_room(building, *route.shuttle, marks.route));
  } else if (!route.random && route.rooms != Route().rooms) {
    for (std::size_t i = 0; i < route.rooms.size(); ++i)
      rooms.push_back(find_room(building, route.rooms[i], i < marks.rooms.size() ? marks.rooms[i] : marks.route));
  }
  std::sort(rooms.begin(), rooms.end());
  rooms.erase(std::unique(rooms.begin(), rooms.end()), rooms.end());
  const sim::MultiStoreyPlanner space(building);
  const RoomPlaces places(building, space);
  std::vector<sim::FloorPoint> goals;
  for (const int room : rooms)
    if (const std::optional<sim::FloorPoint>& goal = places.of(room)) goals.push_back(*goal);
  return goals;
}

}  // namespace

void sample_start(const bim::Building& building, Scenario& scenario, const RouteMarks& marks) {
  Start& start = scenario.start;
  if (start.random) {
    const int storey = storey_of(building, start.storey, marks.start);
    const StartSampler sampler(building, storey, scenario.seed);
    const DrawnStart drawn =
        sampler.start(*start.random, building, goals_of(building, scenario.route, marks), marks.start);
    start.at = drawn.p_W;
    if (!start.yaw_deg && !drawn.narrow) start.yaw_deg = sampler.heading_deg();
    start.storey = building.storeys[static_cast<std::size_t>(storey)].id;
    start.random.reset();
  }
  if (!scenario.route.random) return;
  Route stay;
  stay.rooms = {};
  const RoutePlan at = plan_route(building, start, stay, marks);
  scenario.route.rooms =
      StartSampler(building, at.storey, scenario.seed).route(at.start_W, *scenario.route.random, marks.route);
}

}  // namespace plumbline::scenarios
