// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bim/model/building.h"
#include "scenarios/spec/scenario.h"
#include "sim/route/multi_storey_planner.h"

namespace plumbline::scenarios {

/// Where parts of a scenario stand in its file, for error messages.
struct RouteMarks {
  Mark start;
  Mark route;
  std::vector<Mark> rooms;  ///< of the names in Route::rooms
};

/// Start and route over the storeys of a building.
struct RoutePlan {
  int storey = -1;  ///< of the start
  Eigen::Vector2d start_W = Eigen::Vector2d::Zero();
  double yaw_deg = 0.0;
  std::vector<std::string> rooms;        ///< ids in the order of the walk; "all" resolved
  std::vector<sim::Waypoint> waypoints;  ///< from the start on
  double length_m = 0.0;
  double stairs_m = 0.0;                          ///< of the length, how much leads over stairs
  std::vector<std::string> storeys_out_of_reach;  ///< of a walk of all storeys, each with why
};

/// Index of a storey by id or name; without a name that of RoomPlaces::start_storey. Throws InputError at `mark`.
[[nodiscard]] int storey_of(const bim::Building& building, const std::optional<std::string>& name, const Mark& mark);

/// Plans the walk through the as-built free space and over its stairs. `rooms: all` on the start's storey leaves out
/// rooms where the walk would be longer than `all_longest_m`: far ends come first, then what lies between (tour()).
/// Throws InputError when the start is inside something, on a stair or outside every room, a room is not known, a goal
/// cannot be reached, or `rooms: all` finds nowhere to walk to, with what stops the robot.
[[nodiscard]] RoutePlan plan_route(const sim::MultiStoreyPlanner& space, const Start& start, const Route& route,
                                   const RouteMarks& marks, std::optional<double> all_longest_m = std::nullopt);
/// The same for who asks a building once.
[[nodiscard]] RoutePlan plan_route(const bim::Building& building, const Start& start, const Route& route,
                                   const RouteMarks& marks);

}  // namespace plumbline::scenarios
