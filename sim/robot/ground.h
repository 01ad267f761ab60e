// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "sim/robot/collision.h"

namespace plumbline::sim {

/// The floor of a storey: an infinite plane with wells, where stairs lead down to the storey below.
struct GroundLevel {
  double z_m = 0.0;                          ///< in W
  std::vector<Eigen::AlignedBox2d> wells_W;  ///< around each, surfaces stand for the level
};

/// How far around a well boxes replace the infinite floor plane.
struct WellConfig {
  double plane_from_m = 2.0;  ///< at this distance from every well the floor plane is used
  double boxes_to_m = 3.6;    ///< beyond the above by the robot's reach until the next refresh
};

/// What a robot stands on: the infinite floor planes of storeys, and boxes (steps, landings, floor around wells, ramps,
/// sills) whose upper side is walked on.
class Ground {
 public:
  /// One infinite floor plane.
  explicit Ground(double floor_z_W = 0.0);
  /// levels: ascending, at least one; surfaces in any order, the same to all levels.
  Ground(std::vector<GroundLevel> levels, std::vector<CollisionBox> surfaces, const WellConfig& config = {});

  /// Height of the floor plane for a robot whose base is at p_W: the highest level below it without a well nearby,
  /// else the lowest level.
  [[nodiscard]] double plane_height(const Eigen::Vector3d& p_W) const;
  /// Height of what carries a foot at (x, y), at or below z_max; of the lowest level where that is above z_max.
  [[nodiscard]] double height(double x, double y, double z_max) const;
  [[nodiscard]] const std::vector<CollisionBox>& surfaces() const { return surfaces_; }

 private:
  [[nodiscard]] bool has_plane_at(const GroundLevel& level, const Eigen::Vector2d& p_W) const;

  WellConfig config_;
  std::vector<GroundLevel> levels_;
  std::vector<CollisionBox> surfaces_;
  std::vector<Eigen::AlignedBox2d> extents_W_;  ///< of the surfaces
};

/// The ground of the storeys a route touches (indices, any order): their floors, and steps and landings of the stairs
/// between two of them with the floor around their heads; sills of doors. Throws InputError when a storey does not
/// exist or there is none.
[[nodiscard]] Ground building_ground(const bim::Building& as_built, const std::vector<int>& storeys);

}  // namespace plumbline::sim
