// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "bim/model/building.h"
#include "sim/route/route.h"

namespace plumbline::sim {

/// What a stair must be like for the robot to climb it; tried up to a rise of 19 cm on a run of 26 cm.
struct StairWayConfig {
  double rise_max_m = 0.20;
  double run_min_m = 0.24;
  double level_m = 0.05;         ///< a landing and the end of a flight this near in height belong together
  double offset_m = 0.05;        ///< flights without a landing between them run straight on, to within this
  double behind_m = 0.6;         ///< where the robot turns to face a flight it needs so much of the landing behind it,
  double turn_at_least_m = 0.3;  ///< but no nearer to the flight than this
  double sample_m = 0.1;         ///< spacing at which the path is checked for obstacles
};

/// The path up one stair: along the middle of each flight, over each landing.
struct StairWay {
  std::string id;
  int from = -1;                        ///< storey at the foot
  int to = -1;                          ///< storey at the head
  std::vector<Eigen::Vector3d> points;  ///< foot of the first step, where it turns, edge of the floor above; W
  Eigen::Vector2d into = Eigen::Vector2d::Zero();    ///< unit, direction of the first flight
  Eigen::Vector2d out_of = Eigen::Vector2d::Zero();  ///< and of the last
  std::string fault;  ///< why the robot cannot walk it, as a predicate ("is 0.6 m wide"); empty when it can
};

/// One entry a stair, in the order of the building.
[[nodiscard]] std::vector<StairWay> stair_ways(const bim::Building& as_built, const RouteConfig& route = {},
                                               const StairWayConfig& config = {});

}  // namespace plumbline::sim
