// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bim/config/tree.h"
#include "bim/load/load.h"
#include "scenarios/spec/route_plan.h"
#include "sim/route/blockage.h"

namespace plumbline::scenarios {

inline constexpr double default_longest_s = 600.0;  ///< a default walk takes no longer

/// A room of the start's storey that the robot does not get to, and what stops it, from the start on.
struct RoomOutOfReach {
  std::string id;
  std::string name;  ///< as on the page: its name, or its id where it has none
  std::string why;
  std::vector<sim::Blockage> blockages;  ///< none where the room itself is too small
};

/// A room in reach of which a part is not.
struct RoomInPart {
  std::string name;
  double share = 0.0;  ///< of its walkable floor that is out of reach
};

/// What of the start's storey a planned walk covers, and why no more. It follows from the building and the route alone.
struct WalkCoverage {
  std::string storey;                             ///< its name
  int rooms = 0;                                  ///< on the storey
  int in_reach = 0;                               ///< of these, also over stairs and back
  int on_route = 0;                               ///< of these, entered by the walk
  int elsewhere = 0;                              ///< rooms of other storeys that the walk enters
  std::vector<RoomOutOfReach> out_of_reach;       ///< in the order of the building
  std::vector<std::string> storeys_out_of_reach;  ///< of a walk of all storeys, each with why
  std::vector<RoomInPart> in_part;                ///< where the share is more than a tenth
  std::vector<std::string> left_out;              ///< names of rooms in reach that the walk does not enter
  std::size_t at_edge = 0;                        ///< of these, named by the route, which passes their edge
  std::vector<std::string> route_rooms;           ///< ids of the rooms that the route names, each once
  bool floor_assumed = false;                     ///< neither slabs nor rooms say where it is
  double planned_m = 0.0;
  double stairs_m = 0.0;                            ///< of this over stairs
  Eigen::Vector2d end_W = Eigen::Vector2d::Zero();  ///< of the walk
};

/// What the robot walks through: as built, with the rooms of the plan, so that a route may name any of them.
[[nodiscard]] bim::Building walked_building(const bim::PlannedAndBuilt& site);

[[nodiscard]] WalkCoverage walk_coverage(const sim::MultiStoreyPlanner& space, const RoutePlan& plan);
/// The same of a scenario whose start and route are resolved.
[[nodiscard]] WalkCoverage walk_coverage(const bim::PlannedAndBuilt& site, const Scenario& resolved);

/// Time for a walk of which so much leads over stairs, with turns on the spot and to stand at the end, whole s.
[[nodiscard]] double walk_duration(double length_m, double stairs_m, double speed_mps);
/// Length of a walk on the floor for which so much time suffices, m.
[[nodiscard]] double walk_length(double duration_s, double speed_mps);

/// Sentences about a walk that shows little of its storey, each with what would help.
[[nodiscard]] std::vector<std::string> walk_warnings(const WalkCoverage& walk);

/// Rooms out of reach by what stops the robot, a line each: "Office, Store: door 'd1' is closed". At most so many
/// lines, then how many rooms more there are.
[[nodiscard]] std::vector<std::string> out_of_reach_lines(const WalkCoverage& walk, std::size_t most);

/// How many rooms in reach a default walk leaves out or only passes, and why.
[[nodiscard]] std::vector<std::string> left_out_lines(const WalkCoverage& walk);

/// "62.1 m through 5 of the 8 rooms on Level 1, of which 6 are in reach".
[[nodiscard]] std::string walk_sentence(const WalkCoverage& walk);

/// Block `walk` of results.json.
[[nodiscard]] Tree to_results(const WalkCoverage& walk, const std::vector<std::string>& warnings);

}  // namespace plumbline::scenarios
