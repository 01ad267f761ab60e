// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/spec/run_building.h"
#include "scenarios/spec/scenario.h"
#include "scenarios/spec/walk_coverage.h"
#include "sim/world.h"
#include "slam/methods.h"

namespace plumbline::scenarios {

/// What the command line says over the scenario.
struct Overrides {
  std::optional<std::vector<std::string>> methods;  ///< gates of methods left out are dropped
  std::optional<std::uint64_t> seed;
  std::vector<ProcessSpec> processes = {};  ///< that `methods` names, besides those of the scenario
};

/// A scenario with its building, every choice made.
struct ResolvedScenario {
  Scenario scenario;  ///< start, route and methods resolved; `building` names the copy in a run directory
  std::shared_ptr<const RunBuilding> building;  ///< as planned for the methods, as built for the world
  std::string building_bytes;                   ///< the file as it was read
  sim::WorldConfig world;                       ///< until the robot is lifted, where it is
  std::optional<sim::WorldConfig> world_after;  ///< from where it is set down, until the end of the scenario
  slam::Prior prior;
  slam::Calibration calibration = sim::World::calibration();  ///< as methods are told, off by the mount's error
  WalkCoverage walk;                                          ///< what of its storey the walk covers
  bool own_route = false;                                     ///< the scenario says where to walk
  int dropped_gates = 0;                                      ///< gates of methods that Overrides left out
  slam::MethodTable table;                                    ///< where its methods stand; must outlive this
  std::shared_ptr<const ProcessTable> processes;              ///< the table, where the scenario has processes
};

/// Reads INPUT (a scenario or the name of one in the library, a plan, an .ifc or a mesh; all but the first get the
/// default scenario: start in the largest room of the largest piece of floor of the lowest storey with rooms, route
/// through all rooms in reach on it or as many as 10 minutes allow, every method; in a mesh, which has no rooms, the
/// freest place, a round through what can be reached, and the methods that need no plan) and checks everything that can
/// be known before the first step. Throws InputError at the place in the file that is wrong.
[[nodiscard]] ResolvedScenario resolve(const std::string& input, const Overrides& overrides,
                                       slam::MethodTable table = slam::methods());

/// What is to be said of a default walk before it begins: people without chairs, rooms out of reach and why, rooms
/// left out, warnings. A line each.
[[nodiscard]] std::vector<std::string> walk_notes(const ResolvedScenario& resolved);

/// Checks that methods are known, asked for once, and can do with the sensors that their labels name; `marks[i]` says
/// where name i stands.
void check_methods(const std::vector<std::string>& names, const std::vector<Mark>& marks,
                   slam::MethodTable table = slam::methods());

}  // namespace plumbline::scenarios
