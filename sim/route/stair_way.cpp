// SPDX-License-Identifier: Apache-2.0
#include "sim/route/stair_way.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "bim/config/tree.h"
#include "bim/model/stair_flight.h"
#include "sim/route/obstacle_footprint.h"

namespace plumbline::sim {

namespace {

double head_z(const bim::StairFlight& flight) { return flight.z0_m + flight.steps * flight.rise_m; }

std::string metres(double x) { return format_number(std::round(x * 1e3) / 1e3) + " m"; }

std::string flight_fault(const bim::StairFlight& flight, const RouteConfig& route, const StairWayConfig& config) {
  constexpr double slack = 1e-6;
  if (flight.width_m < 2.0 * route.radius_m - slack)
    return "is " + metres(flight.width_m) + " wide; the robot needs " + metres(2.0 * route.radius_m);
  if (flight.rise_m > config.rise_max_m + slack)
    return "has steps of " + metres(flight.rise_m) + "; the robot climbs up to " + metres(config.rise_max_m);
  if (flight.run_m < config.run_min_m - slack)
    return "has steps " + metres(flight.run_m) + " deep; the robot needs " + metres(config.run_min_m);
  return "";
}

/// How far a landing reaches from p along e, m.
double reach(const bim::Landing& landing, const Eigen::Vector2d& p, const Eigen::Vector2d& e) {
  double most = 0.0;
  for (const Eigen::Vector2d& vertex : landing.polygon) most = std::max(most, e.dot(vertex - p));
  return most;
}

/// The landing that joins the head of one flight with the foot of the next.
const bim::Landing* landing_between(const bim::Stair& stair, const bim::StairFlight& lower,
                                    const bim::StairFlight& upper, const StairWayConfig& config) {
  const auto joins = [&](const bim::Landing& landing) {
    return std::abs(landing.z_m - head_z(lower)) < lower.rise_m + config.level_m &&
           std::abs(landing.z_m - upper.z0_m) < config.level_m &&
           (contains(landing.polygon, bim::head_of(lower, 0.0)) ||
            boundary_distance(landing.polygon, bim::head_of(lower, 0.0)) < config.offset_m) &&
           (contains(landing.polygon, upper.start) ||
            boundary_distance(landing.polygon, upper.start) < config.offset_m);
  };
  const auto found = std::find_if(stair.landings.begin(), stair.landings.end(), joins);
  return found == stair.landings.end() ? nullptr : &*found;
}

/// Adds where the path turns between two flights: in the middle of the landing, and where it turns twice, the second
/// time so near to the upper flight that the knees clear what is behind.
std::string turn(const bim::Stair& stair, const bim::StairFlight& lower, const bim::StairFlight& upper,
                 const RouteConfig& route, const StairWayConfig& config, std::vector<Eigen::Vector3d>& points) {
  const bim::Landing* landing = landing_between(stair, lower, upper, config);
  const Eigen::Vector2d on = upper.start - bim::head_of(lower, 0.0), e = bim::ascent(lower);
  const bool straight = e.dot(bim::ascent(upper)) > 0.99 && std::abs(e.x() * on.y() - e.y() * on.x()) < config.offset_m;
  if (landing != nullptr && straight) return "";
  if (landing == nullptr)
    return straight && on.norm() < config.offset_m
               ? ""
               : "winds; the robot walks straight flights with landings between them";
  const double before = 0.5 * reach(*landing, bim::head_of(lower, 0.0), e);
  const double depth = reach(*landing, upper.start, -bim::ascent(upper));
  if (std::min(before, 0.5 * depth) < route.radius_m - 0.5 * route.cell_m)
    return "has a landing " + metres(2.0 * std::min(before, 0.5 * depth)) + " deep; the robot needs " +
           metres(2.0 * route.radius_m);
  const Eigen::Vector2d a = bim::head_of(lower, 0.0) + before * e;
  points.emplace_back(a.x(), a.y(), landing->z_m);
  if ((upper.start - 0.5 * depth * bim::ascent(upper) - a).norm() <= config.offset_m) return "";
  const double after = std::min(0.5 * depth, std::max(config.turn_at_least_m, depth - config.behind_m));
  const Eigen::Vector2d b = upper.start - after * bim::ascent(upper);
  points.emplace_back(b.x(), b.y(), landing->z_m);
  return "";
}

/// Possible obstacles of a stair: walls, columns, obstacles and other stairs near it. Floors are cut for it already.
bim::Building surroundings(const bim::Building& building, const bim::Stair& stair, const Eigen::AlignedBox2d& box) {
  bim::Building near;
  const auto meets = [&](const std::vector<Eigen::Vector2d>& points) {
    Eigen::AlignedBox2d other;
    for (const Eigen::Vector2d& p : points) other.extend(p);
    return other.intersects(box);
  };
  for (std::size_t i = 0; i < building.walls.size(); ++i) {
    const bim::Wall& wall = building.walls[i];
    const double width = std::abs(wall.offset_m) + wall.thickness_m;
    const Eigen::Vector2d margin = Eigen::Vector2d::Constant(width);
    if (!meets({wall.a - margin, wall.a + margin, wall.b - margin, wall.b + margin})) continue;
    for (bim::Opening opening : building.openings) {
      if (opening.wall != static_cast<int>(i)) continue;
      opening.wall = static_cast<int>(near.walls.size());
      near.openings.push_back(std::move(opening));
    }
    near.walls.push_back(wall);
  }
  for (const bim::Column& column : building.columns)
    if (meets(column.footprint)) near.columns.push_back(column);
  const auto body_meets = [&](const bim::Solid& body) {
    std::vector<Eigen::Vector2d> seen;
    for (const Eigen::Vector3d& p : body.vertices) seen.emplace_back(p.head<2>());
    return meets(seen);
  };
  for (const bim::Obstacle& obstacle : building.obstacles)
    if (body_meets(obstacle.body)) near.obstacles.push_back(obstacle);
  for (const bim::Stair& other : building.stairs)
    if (&other != &stair && std::any_of(other.bodies.begin(), other.bodies.end(), body_meets))
      near.stairs.push_back(other);
  return near;
}

/// A stretch of the path at one height.
struct Level {
  double z = 0.0;
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
};

/// On a flight what is no higher than the steps within the radius ahead, or than the floor they lead to, is not in the
/// way: the level is theirs.
std::vector<Level> levels_of(const bim::Stair& stair, const std::vector<Eigen::Vector3d>& points,
                             const RouteConfig& route) {
  std::vector<Level> levels;
  for (std::size_t i = 0; i < stair.flights.size(); ++i) {
    const bim::StairFlight& flight = stair.flights[i];
    const double top = i + 1 < stair.flights.size() ? stair.flights[i + 1].z0_m : points.back().z();
    const double ahead = std::ceil(route.radius_m / flight.run_m) * flight.rise_m;
    for (int k = 0; k < flight.steps; ++k) {
      const Eigen::Vector2d a = flight.start + k * flight.run_m * bim::ascent(flight);
      const double z = flight.z0_m + (k + 1) * flight.rise_m;
      levels.push_back({std::min(top, z + ahead), a, a + flight.run_m * bim::ascent(flight)});
    }
  }
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const std::size_t next = i + 2 < points.size() && points[i + 1].z() == points[i].z() ? i + 1 : i;
    levels.push_back({points[i].z(), points[i].head<2>(), points[next].head<2>()});
  }
  return levels;
}

/// True where a point of the level is nearer than the radius to something.
bool blocked(const bim::Building& near, const Level& level, const RouteConfig& route, const StairWayConfig& config) {
  const double wanted = route.radius_m - 0.5 * route.cell_m;
  const int count = 1 + static_cast<int>((level.b - level.a).norm() / config.sample_m);
  for (const ObstacleFootprint& footprint : find_obstacle_footprints(near, level.z, route)) {
    for (int i = 0; i <= count; ++i) {
      const Eigen::Vector2d p = level.a + (level.b - level.a) * (static_cast<double>(i) / count);
      for (const Segment2& edge : footprint.edges)
        if (segment_distance(edge.a, edge.b, p) < wanted) return true;
    }
  }
  return false;
}

std::string obstacle_fault(const bim::Building& building, const bim::Stair& stair, const StairWay& way,
                           const RouteConfig& route, const StairWayConfig& config) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& p : way.points) box.extend(Eigen::Vector2d(p.head<2>()));
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(2.0 * route.radius_m);
  const bim::Building near = surroundings(building, stair, {box.min() - margin, box.max() + margin});
  for (const Level& level : levels_of(stair, way.points, route))
    if (blocked(near, level, route, config))
      return "has less than " + metres(2.0 * route.radius_m) + " free near [" +
             format_number(std::round(level.a.x() * 1e2) / 1e2) + ", " +
             format_number(std::round(level.a.y() * 1e2) / 1e2) + "]";
  return "";
}

StairWay way_of(const bim::Building& building, const bim::Stair& stair, const RouteConfig& route,
                const StairWayConfig& config) {
  StairWay way;
  way.id = stair.id;
  way.from = stair.from;
  way.to = stair.to;
  if (stair.flights.empty()) {
    way.fault = "is a body without recognizable steps";
    return way;
  }
  if (stair.from < 0 || stair.to < 0 || stair.from == stair.to) {
    way.fault = "does not lead from one storey to another";
    return way;
  }
  way.into = bim::ascent(stair.flights.front());
  way.out_of = bim::ascent(stair.flights.back());
  const Eigen::Vector2d foot = stair.flights.front().start, edge = bim::head_of(stair.flights.back(), 0.0);
  way.points.emplace_back(foot.x(), foot.y(), building.storeys[static_cast<std::size_t>(stair.from)].elevation_m);
  for (std::size_t i = 0; i < stair.flights.size() && way.fault.empty(); ++i) {
    way.fault = flight_fault(stair.flights[i], route, config);
    if (way.fault.empty() && i + 1 < stair.flights.size())
      way.fault = turn(stair, stair.flights[i], stair.flights[i + 1], route, config, way.points);
  }
  way.points.emplace_back(edge.x(), edge.y(), building.storeys[static_cast<std::size_t>(stair.to)].elevation_m);
  if (way.fault.empty()) way.fault = obstacle_fault(building, stair, way, route, config);
  return way;
}

}  // namespace

std::vector<StairWay> stair_ways(const bim::Building& as_built, const RouteConfig& route,
                                 const StairWayConfig& config) {
  std::vector<StairWay> ways;
  for (const bim::Stair& stair : as_built.stairs) ways.push_back(way_of(as_built, stair, route, config));
  return ways;
}

}  // namespace plumbline::sim
