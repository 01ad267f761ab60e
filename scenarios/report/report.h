// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "bim/building/plan.h"
#include "bim/config/tree.h"
#include "scenarios/report/deviations.h"
#include "slam/io/estimate.h"

namespace plumbline::scenarios {

/// One pose as drawn: in W, a SLAM method's after alignment to the truth.
struct ReportSample {
  double t_s = 0.0;
  double x = 0.0;
  double y = 0.0;
  double yaw = 0.0;      ///< rad
  double error_m = 0.0;  ///< distance to the true position (0 for the truth itself)
  int storey = 0;        ///< index into Plan::storeys, by its height
};

/// A believed wall face, as a segment in W.
struct ReportWall {
  Eigen::Vector2d p0 = Eigen::Vector2d::Zero();
  Eigen::Vector2d p1 = Eigen::Vector2d::Zero();
  int storey = 0;
};

struct ReportRoom {
  Polygon2 polygon_W;
  bool matched = false;  ///< with a room of the building
  int storey = 0;
};

/// The belief of a plan localization at one time.
struct ReportBelief {
  std::string label;  ///< "start", "middle", "convergence"
  double t_s = 0.0;
  std::vector<slam::Particle> particles;
  Eigen::Vector2d truth = Eigen::Vector2d::Zero();
  int storey = 0;  ///< the one the robot was on
};

/// Hypotheses alive and the state, over time.
struct ReportState {
  double t_s = 0.0;
  int hypotheses = 0;
  slam::State state = slam::State::searching;
};

struct ReportMethod {
  std::string name;
  bool localization = false;
  std::vector<ReportSample> samples;
  std::vector<ReportWall> walls;
  std::vector<ReportRoom> rooms;
  std::vector<ReportBelief> beliefs;
  std::vector<ReportState> states;
};

/// A storey with a map of its own.
struct ReportStorey {
  int index = 0;  ///< into Plan::storeys
  std::string name;
  std::vector<ReportDeviation> deviations;
};

/// Everything the page shows. `results` is results.json; the rest comes from the other files of the run directory.
struct ReportInput {
  Tree results;
  bim::Plan plan;
  std::vector<ReportStorey> storeys;  ///< those the robot was on, from the lowest up; at least one
  std::vector<ReportSample> truth;
  std::vector<ReportMethod> methods;
};

/// One self-contained HTML page: the plan of every storey the robot was on, true and estimated trajectories, found
/// walls and rooms, error over time, what was built otherwise than planned, particles at start, middle and convergence,
/// gates, every number. The same input gives the same bytes.
[[nodiscard]] std::string render_report(const ReportInput& input);

}  // namespace plumbline::scenarios
