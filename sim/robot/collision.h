// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/geometry/pose.h"
#include "bim/model/building.h"

namespace plumbline::sim {

/// Static box the robot can bump into: pose of its centre, half sizes, m. Robots collide with boxes near them only.
struct CollisionBox {
  int id = 0;  ///< stable order
  Pose X_WB;
  Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5);
};

/// Distance from a point to a box, m, 0 inside.
[[nodiscard]] double distance(const CollisionBox& box, const Eigen::Vector3d& p_W);

struct CollisionConfig {
  double floor_gap_m = 0.03;  ///< what ends this low above the floor is no obstacle
  double reach_m = 1.2;       ///< what starts this high above the floor cannot be touched
  double length_max_m = 4.0;  ///< longer walls are split, so that distant parts stay out of the pool
  double box_fill = 0.5;      ///< an obstacle that fills less of its bounding box is taken apart
  double full_fill = 0.95;    ///< one larger than passage_m that fills less than this may have a way through it
  double passage_m = 1.2;     ///< least length of an obstacle that a robot can walk through: 0.8 m and its two sides
  double cell_m = 0.10;       ///< into cells of this size,
  double cells_max = 5e6;     ///< of which 200 m by 200 m and a margin are fewer
  double sill_max_m = 0.2;    ///< the wall under a door that ends so low is floor (see building_ground)
  double shell_m = 0.02;      ///< half thickness of the boxes along the faces of a wall that is not straight
  double weld_m = 1e-5;       ///< vertices this close are joined for the test whether an obstacle is closed
};

/// True when the stair has steps and joins two of the storeys: it is floor there (see building_ground), no obstacle.
[[nodiscard]] bool is_walked(const bim::Stair& stair, const std::vector<int>& storeys);

/// Boxes of what stands on the given storeys of the as-built building, ids ascending from 0: walls with their openings
/// cut out (pieces beside the opening, lintel above, sill below), columns, stairs that are not walked, and obstacles.
/// Walls whose bodies are curved or have gaps are the surfaces of these.
[[nodiscard]] std::vector<CollisionBox> collision_boxes(const bim::Building& as_built, const std::vector<int>& storeys,
                                                        const CollisionConfig& config = {});

}  // namespace plumbline::sim
