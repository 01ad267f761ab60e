// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "bim/config/tree.h"
#include "bim/plan/plan.h"
#include "scenarios/report/deviation_list.h"
#include "scenarios/report/obstacles.h"
#include "scenarios/spec/injected_faults.h"
#include "slam/io/estimate.h"

namespace plumbline::scenarios {

/// One pose as drawn: in W, a SLAM method's after alignment to the truth.
struct ReportSample {
  double t_s = 0.0;
  double x = 0.0;
  double y = 0.0;
  double yaw = 0.0;                                   ///< rad
  double error_m = 0.0;                               ///< distance to the true position (0 for the truth itself)
  int storey = 0;                                     ///< index into Plan::storeys, by its height
  bool lost = false;                                  ///< the method said that it is lost: this is no answer
  Eigen::Vector3d error_W = Eigen::Vector3d::Zero();  ///< estimated minus true position, m
  double yaw_error = 0.0;                             ///< estimated minus true, rad, in (-pi, pi]
  std::optional<double> relative_m = {};              ///< error of the motion over the last metre walked, m
  bool judged = true;                                 ///< a true pose is known, so that the errors say something
};

/// Two points of a path further apart than this in time or in space are not joined: the robot was carried, or the
/// method changed its answer.
struct PathBreaks {
  double gap_s = 1.0;
  double jump_m = 1.0;
};

/// A wall face of an estimate or of the plan, as a segment in W.
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

/// A stretch of one hypothesis of a plan localization over time, in which it is the true pose or is not.
struct HypothesisHistory {
  int hypothesis = 0;                   ///< which; one that becomes right or wrong has several stretches
  bool is_true = false;                 ///< it is the true pose, at each of its scans
  std::string room;                     ///< in which it came up first, may be empty
  std::vector<Eigen::Vector2d> points;  ///< (time in s, mass in [0, 1])
};

/// A wall of the plan that was matched at a hypothesis, in W.
struct ReportMatch {
  std::vector<ReportWall> faces;  ///< of the plan
  ReportWall patch;               ///< the observed wall, seen from the hypothesis
  bool right = false;             ///< it was that wall
};

/// A hypothesis at one time.
struct ReportHypothesis {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double yaw = 0.0;   ///< rad
  double mass = 0.0;  ///< in [0, 1]
  std::vector<ReportMatch> walls;
};

/// The walls matched at one time.
struct ReportWalls {
  std::string label;  ///< "at convergence", "at the end"
  double t_s = 0.0;
  int storey = 0;  ///< the one the robot was on
  Eigen::Vector2d truth = Eigen::Vector2d::Zero();
  std::vector<ReportHypothesis> hypotheses;
};

struct ReportMethod {
  std::string name;
  bool localization = false;
  std::size_t ink = 0;  ///< which of the methods' colours; the truth takes none
  std::vector<ReportSample> samples;
  std::vector<ReportWall> walls;
  std::vector<ReportRoom> rooms;
  std::vector<ReportBelief> beliefs;
  std::vector<ReportState> states;
  std::vector<HypothesisHistory> histories;
  std::vector<Eigen::Vector2d> other_hypotheses;  ///< (time in s, mass) of those without a history, together
  std::size_t hypotheses_left_out = 0;            ///< how many have none
  std::optional<double> failed_s = {};            ///< when it was first lost or far off, on the run's clock
  std::optional<SlipEpisode> slip = {};           ///< of the feet, within the second before
  std::vector<ReportWalls> recognised;
  std::vector<ReportSample> corrected;     ///< the path after the last optimisation, where it is drawn, too
  std::optional<double> converged_s = {};  ///< a mark; without it, by the results
  bool judged = true;                      ///< which of its hypotheses and walls are right is known
  bool lost_drawn = false;                 ///< its path is drawn while it is lost, too, dotted
  PathBreaks breaks = PathBreaks();
  PathBreaks corrected_breaks = PathBreaks();
};

/// A storey with a map of its own.
struct ReportStorey {
  int index = 0;  ///< into Plan::storeys
  std::string name;
  std::vector<ReportDeviation> deviations;
  std::string below_paths = {};  ///< SVG over the plan and under the paths: the points of a map
};

/// A robot that was kidnapped: its last scan before and its first one after.
struct ReportKidnap {
  double lifted_s = 0.0;
  double set_down_s = 0.0;
};

/// Everything the page shows. `results` is results.json; the rest comes from the other files of the run directory.
struct ReportInput {
  Tree results;
  bim::Plan plan;
  std::vector<ReportObstacle> obstacles;
  std::vector<ReportFlight> flights;
  std::vector<ReportStorey> storeys;  ///< those the robot was on, from the lowest up; at least one
  std::vector<ReportSample> truth;
  std::vector<ReportMethod> methods;
  std::optional<ReportKidnap> kidnap;
  bool has_replay = false;                  ///< replay.html stands beside the page
  std::vector<Eigen::Vector2d> extent;      ///< points that maps reach, too
  double mark_scale = 1.0;                  ///< of the marks that stand for the robot
  bool has_plan = true;                     ///< a building is known and drawn
  std::string truth_name = "ground truth";  ///< what its line is called
  PathBreaks truth_breaks = PathBreaks();
};

/// One self-contained HTML page: the plan of every storey the robot was on, true and estimated trajectories, found
/// walls and rooms, error over time, what was built otherwise than planned, the hypotheses of a localization over time
/// and which walls it matched, particles at start, middle and convergence, gates, every number. The same input gives
/// the same bytes.
[[nodiscard]] std::string render_report(const ReportInput& input);

}  // namespace plumbline::scenarios
