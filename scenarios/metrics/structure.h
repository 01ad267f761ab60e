// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "bim/plan/plan.h"
#include "scenarios/metrics/trajectory.h"
#include "slam/io/estimate.h"

namespace plumbline::scenarios::score {

/// Rules of the wall and room metrics, docs/reference/metrics.md.
struct StructureRules {
  double wall_angle_deg = 3.0;
  double wall_offset_m = 0.10;  ///< distance of the middle of the found wall to the true face
  double wall_overlap = 0.5;    ///< share of the found wall's length that lies on true faces
  double seen_within_m = 0.02;  ///< a hit point belongs to a face this near
  double seen_length_m = 0.5;   ///< a face counts as seen when hits span this much of it
  int seen_points = 10;         ///< and are at least so many, on the 0.1 m grid of the hits
  double room_iou = 0.5;
  double room_across_m = 0.5;   ///< two-wall: distance of the centres across the corridor
  double visit_inside_m = 0.5;  ///< depth inside a room that counts
  double visit_s = 2.0;         ///< without leaving that depth
  double storey_m = 0.3;        ///< height of a floor off its storey's, found or stood on
};

struct WallScore {
  double precision = 0.0;        ///< absent walls cannot be scored: see score_walls
  std::optional<double> recall;  ///< absent when no face was seen
  /// PlanFace ids matched by each plane, the longest stretch first; index as in Estimate::planes.
  std::vector<std::vector<int>> faces_of_plane;
  int duplicates = 0;  ///< found walls on stretches that others were matched with
};

struct StoreyScore {
  int visited = 0;                  ///< storeys whose floor the robot stood on
  int found = 0;                    ///< floors that the method claims
  int matched = 0;                  ///< of these, with a storey at their height, one to one
  std::optional<double> precision;  ///< matched / found; absent when none was found
  std::optional<double> recall;     ///< visited storeys that were found / visited; absent when none was visited
};

struct RoomScore {
  int visited = 0;
  int found = 0;
  int matched = 0;                  ///< found rooms that are a room of the building
  std::optional<double> precision;  ///< matched / found; absent when none was found
  std::optional<double> recall;     ///< visited rooms that were found / visited; absent when none was visited
  std::vector<int> room_of_node;    ///< PlanRoom id matched by each found room, -1 none
};

/// Matches found walls with stretches of the faces of the as-built plan, those nearest to a face first (ties: plane).
/// How a plan cuts its walls makes no difference: a found wall may lie along several faces of one plane, and two found
/// walls on one face where they are different stretches of it, as the rooms along a facade see it; a second one on the
/// same stretch is not matched. The estimate's planes are placed in W by X_WF; there must be at least one.
[[nodiscard]] WallScore score_walls(const slam::Estimate& estimate, const Pose& X_WF, const bim::Plan& as_built,
                                    const std::vector<Eigen::Vector3d>& surface_W, const StructureRules& rules = {});

/// Matches found rooms with rooms of the storey their walls stand on, one to one: candidates by falling overlap, ties
/// by found room, then room.
[[nodiscard]] RoomScore score_rooms(const slam::Estimate& estimate, const Pose& X_WF, const bim::Plan& as_built,
                                    const WallScore& walls, const Truth& truth, const StructureRules& rules = {});

/// Matches found floors with storeys by height, the nearest first (ties: found floor, then storey). A robot stands on a
/// floor that is where its feet are for as long as a room is visited.
[[nodiscard]] StoreyScore score_storeys(const slam::Estimate& estimate, const Pose& X_WF, const bim::Plan& as_built,
                                        const Truth& truth, const StructureRules& rules = {});

/// Ids of the rooms the robot's centre was deep enough inside for long enough, ascending.
[[nodiscard]] std::vector<int> visited_rooms(const bim::Plan& as_built, const Truth& truth,
                                             const StructureRules& rules = {});

}  // namespace plumbline::scenarios::score
