// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sim/robot/collision.h"
#include "sim/robot/model.h"

namespace plumbline::sim {

/// Keeps the boxes near the robot in the physics model. MuJoCo tests the world's geoms one by one, so a building's
/// boxes at once would cost more than everything else, docs/methods/robot.md.
class BoxPool {
 public:
  /// boxes in any order; geoms: the model's pool.
  BoxPool(std::vector<CollisionBox> boxes, std::vector<int> geoms, double radius_m);

  /// Puts the boxes within the radius of p_W into the pool, in the order of their ids, and the rest of the pool away.
  /// Of too many the nearest (ties: lower id). Throws ScenarioFailure when one the robot could touch has no place.
  void refresh(mjModel_& model, const Eigen::Vector3d& p_W) const;

 private:
  /// Positions in boxes_, ascending.
  [[nodiscard]] std::vector<std::size_t> near(const Eigen::Vector3d& p_W) const;

  std::vector<CollisionBox> boxes_;  ///< by id
  std::vector<int> geoms_;
  double radius_m_;
};

}  // namespace plumbline::sim
