// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bim/mesh/mesh.h"
#include "bim/model/building.h"
#include "bim/model/walked_floors.h"

namespace plumbline::bim {

/// Rectangle cut out of a face, in the face's own (s, z), m.
struct FaceHole {
  double s0 = 0.0, s1 = 0.0, z0 = 0.0, z1 = 0.0;
};

/// One of the two faces of a wall [shaheer2023, eq. 1-2, with the sign of d corrected]: plane with outward normal n_W
/// and the finite rectangle it occupies, s running from p0 (s = 0) to p1 with free space on the left of p0 to p1.
struct PlanFace {
  int id = -1;
  std::string wall_id;
  int side = 0;     ///< 0: at offset + thickness (left of a to b), 1: at offset
  int storey = -1;  ///< index into Plan::storeys
  Plane plane_W;
  Eigen::Vector2d p0 = Eigen::Vector2d::Zero();  ///< ends in W, m
  Eigen::Vector2d p1 = Eigen::Vector2d::Zero();
  double z0 = 0.0;  ///< bottom and top in W, m
  double z1 = 3.0;
  std::vector<FaceHole> holes;  ///< openings, s from p0
  std::vector<int> rooms;       ///< rooms this face bounds (a long wall bounds several), ascending
};

struct PlanRoom {
  int id = -1;
  std::string name;  ///< the room's id in the building
  int storey = -1;   ///< index into Plan::storeys
  Polygon2 polygon;  ///< in W, m, counter-clockwise
  double z0 = 0.0;   ///< bottom and top in W, m
  double z1 = 3.0;
  std::vector<int> faces;       ///< bounding faces, ascending
  std::vector<int> neighbours;  ///< rooms reached through a door or void, ascending
  std::vector<Polygon2> holes;  ///< as bim::Room has them
};

struct PlanStorey {
  std::string name;
  double elevation_m = 0.0;
  double height_m = 3.0;
  std::optional<WalkedFloors> floors = {};  ///< where they do not all lie at its elevation
};

/// An element other than a wall as an upright prism: a column, planned furniture.
struct PlanSolid {
  std::string id;
  int storey = -1;
  Polygon2 outline;  ///< counter-clockwise
  double z0 = 0.0;
  double z1 = 3.0;
  bool may_have_moved = false;  ///< furniture
};

/// The plan that an estimator may use, in W. All parts stand in one coordinate frame so that moving the plan by
/// a rigid motion moves every answer with it.
struct Plan {
  std::vector<PlanStorey> storeys;
  std::vector<PlanFace> faces;
  std::vector<PlanRoom> rooms;
  std::vector<PlanSolid>
      solids;  ///< columns that are upright prisms, then obstacles that fill their convex hull, unlike tables
  /// What was built to stay, as a LiDAR sees it: no furniture, no panes, doors open. Empty in a plan that was not made
  /// from a building; faces and solids stand for it there.
  BuildingMesh structure;
  /// Furniture where it was planned, as a LiDAR sees it: empty where none was, or where an estimator is told of none.
  BuildingMesh furniture;
};

/// Plan of an as-planned building. mesh: as build_mesh gives it for the same building.
[[nodiscard]] Plan make_plan(const Building& as_planned, const BuildingMesh& mesh);
[[nodiscard]] Plan make_plan(const Building& as_planned);
/// The plan moved by a rotation about z and a translation: p_V = X_VW p_W.
[[nodiscard]] Plan transformed(const Plan& plan_W, const Pose& X_VW);

}  // namespace plumbline::bim
