// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/why_no_way.h"

#include <optional>
#include <vector>

#include "bim/config/tree.h"
#include "scenarios/spec/closed_doors.h"
#include "scenarios/spec/room_places.h"
#include "scenarios/spec/storeys_out_of_reach.h"
#include "sim/route/blockage.h"

namespace plumbline::scenarios {

namespace {

/// Clauses on what stops the robot on one storey; empty where nothing does.
std::string clauses(const std::vector<sim::Blockage>& blockages) {
  std::string list;
  for (const sim::Blockage& blockage : blockages) list += (list.empty() ? "" : "; ") + blockage.text;
  return list;
}

/// What stops the robot before the stairs that could be climbed from its storey; empty where nothing does.
std::string before_stairs(const sim::MultiStoreyPlanner& space, const sim::FloorPoint& from) {
  const sim::Blockages blockages(space.building(), from.storey, space.storey(from.storey), from.p_W);
  for (const sim::StairWay& way : space.stairs()) {
    if (!way.fault.empty() || (way.from != from.storey && way.to != from.storey)) continue;
    const Eigen::Vector3d& end = way.from == from.storey ? way.points.front() : way.points.back();
    if (const std::string list = clauses(blockages.before(end.head<2>())); !list.empty())
      return "on the way to stair '" + way.id + "' " + list;
  }
  return "";
}

}  // namespace

std::string why_no_way(const sim::MultiStoreyPlanner& space, const sim::FloorPoint& from, const sim::FloorPoint& goal) {
  const bim::Building& building = space.building();
  if (const std::vector<std::string> doors = closed_doors_between(building, from, goal); !doors.empty())
    return ": " + open_them(doors);
  if (from.storey != goal.storey) {
    const std::string stop = before_stairs(space, from);
    return ", since it is on storey '" + building.storeys[static_cast<std::size_t>(goal.storey)].id +
           "': " + (stop.empty() ? stairs_at_fault(space) : stop);
  }
  const sim::Blockages blockages(building, from.storey, space.storey(from.storey), from.p_W);
  const std::string stop = clauses(blockages.before(goal.p_W));
  return stop.empty() ? "; is every door on the way at least 0.9 m wide, and nothing in it?" : ": " + stop;
}

std::string why_nowhere_to_walk(const sim::MultiStoreyPlanner& space, const sim::FloorPoint& from) {
  const sim::ClearanceMap& floor = space.storey(from.storey);
  const sim::Blockages blockages(space.building(), from.storey, floor, from.p_W);
  const std::string start = "give a start: {storey: ..., at: [x, y]} ";
  for (const bim::Room& other : space.building().rooms) {
    if (other.storey != from.storey || other.contains(from.p_W)) continue;
    const std::optional<std::size_t> goal = floor.freest_cell(other);
    if (!goal) continue;
    if (const std::string list = clauses(blockages.before(floor.grid().center(*goal))); !list.empty())
      return ": on the way to room " + quoted(other) + " " + list + "; " + start + "from where the robot can walk";
  }
  return ": the robot needs " + format_number(2.0 * sim::RouteConfig().turn_m) +
         " m to turn round, and this piece of floor has no two places for that; clear it, or " + start +
         "on a larger one";
}

}  // namespace plumbline::scenarios
