// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/model/building.h"
#include "scenarios/spec/scenario.h"
#include "sim/route/waypoint.h"

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
  double stairs_m = 0.0;  ///< of the length, how much leads over stairs
};

/// The lowest storey with a room the robot can stand in, or -1.
[[nodiscard]] int lowest_habitable_storey(const bim::Building& building);

/// Index of a storey by id or name, or of the lowest habitable one without a name. Throws InputError at `mark`.
[[nodiscard]] int storey_of(const bim::Building& building, const std::optional<std::string>& name, const Mark& mark);

/// Where on a storey no floor is stood on: under or over a stair.
[[nodiscard]] bool on_a_stair(const bim::Building& building, int storey, const Eigen::Vector2d& p_W);

/// In the plane: in a door that is open, or a void, of a storey's walls.
[[nodiscard]] bool in_a_doorway(const bim::Building& building, int storey, const Eigen::Vector2d& p_W);

/// Plans the walk through the as-built free space and over its stairs. Throws InputError when the start is inside
/// something, on a stair or outside every room, a room is not known, or a goal cannot be reached.
[[nodiscard]] RoutePlan plan_route(const bim::Building& building, const Start& start, const Route& route,
                                   const RouteMarks& marks);

}  // namespace plumbline::scenarios
