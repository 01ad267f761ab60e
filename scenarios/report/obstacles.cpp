// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/obstacles.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "bim/model/fillings.h"
#include "bim/model/hull.h"
#include "sim/route/route.h"

namespace plumbline::scenarios {

namespace {

bool stands_in_the_way(const bim::Building& building, int storey, double z0, double z1) {
  const sim::RouteConfig route;
  if (storey < 0) return false;
  const double floor = building.storeys[static_cast<std::size_t>(storey)].elevation_m;
  return z1 > floor + route.band_low_m && z0 < floor + route.band_high_m;
}

}  // namespace

std::vector<ReportFlight> flights_of(const bim::Building& building) {
  std::vector<ReportFlight> flights;
  for (const bim::Stair& stair : building.stairs)
    for (const bim::StairFlight& flight : stair.flights) {
      ReportFlight shown{stair.from, stair.to, {}};
      const Eigen::Vector2d up(std::cos(flight.yaw), std::sin(flight.yaw)), left(-up.y(), up.x());
      for (int i = 0; i <= flight.steps; ++i) {
        const Eigen::Vector2d at = flight.start + i * flight.run_m * up, half = 0.5 * flight.width_m * left;
        shown.risers_W.emplace_back(at - half, at + half);
      }
      flights.push_back(std::move(shown));
    }
  return flights;
}

std::vector<ReportObstacle> obstacles_of(const bim::Building& building, const bim::Plan& plan) {
  std::vector<ReportObstacle> obstacles;
  std::set<std::string> solid;
  for (const bim::PlanSolid& prism : plan.solids) {
    solid.insert(prism.id);
    if (stands_in_the_way(building, prism.storey, prism.z0, prism.z1))
      obstacles.push_back({prism.id, prism.storey, prism.outline, true});
  }
  for (const bim::Column& column : building.columns)
    if (!solid.contains(column.id) && column.footprint.size() >= 3 &&
        stands_in_the_way(building, column.storey, column.z0_m, column.z1_m))
      obstacles.push_back({column.id, column.storey, column.footprint, false});
  for (const bim::Obstacle& obstacle : building.obstacles) {
    const std::vector<Eigen::Vector3d>& corners = obstacle.body.vertices;
    if (solid.contains(obstacle.id) || bim::is_filling(obstacle) || corners.empty()) continue;
    const auto [low, high] =
        std::minmax_element(corners.begin(), corners.end(), [](const auto& p, const auto& q) { return p.z() < q.z(); });
    if (!stands_in_the_way(building, obstacle.storey, low->z(), high->z())) continue;
    Polygon2 below;
    for (const Eigen::Vector3d& p : corners) below.emplace_back(p.head<2>());
    Polygon2 hull = bim::convex_hull(std::move(below));
    if (!hull.empty()) obstacles.push_back({obstacle.id, obstacle.storey, std::move(hull), false});
  }
  return obstacles;
}

}  // namespace plumbline::scenarios
