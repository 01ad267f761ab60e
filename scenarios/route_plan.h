// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/building/building.h"
#include "scenarios/scenario.h"

namespace plumbline::scenarios {

/// Where things of a scenario stand in its file, for complaints.
struct RouteMarks {
  Mark start;
  Mark route;
  std::vector<Mark> rooms;  ///< of the names in Route::rooms
};

/// Start and route in the plane of one storey.
struct RoutePlan {
  int storey = -1;
  Eigen::Vector2d start_W = Eigen::Vector2d::Zero();
  double yaw_deg = 0.0;
  std::vector<std::string> rooms;          ///< ids in the order of the walk; "all" settled
  std::vector<Eigen::Vector2d> waypoints;  ///< from the start on
  double length_m = 0.0;
};

/// The lowest storey with a room the robot can stand in, or -1.
[[nodiscard]] int lowest_habitable_storey(const bim::Building& building);

/// Plans the walk through the as-built free space. Throws InputError when the start is inside something or outside
/// every room, a room is not known, or a goal cannot be reached.
[[nodiscard]] RoutePlan plan_route(const bim::Building& building, const Start& start, const Route& route,
                                   const RouteMarks& marks);

}  // namespace plumbline::scenarios
