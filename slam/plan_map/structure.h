// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "bim/mesh/mesh.h"
#include "bim/rays/ray_scene.h"

namespace plumbline::slam {

/// Where a ray meets what was built to stay. Frame I.
struct StructureHit {
  double distance = 0.0;                        ///< horizontal, m
  int element = -1;                             ///< of the plan's structure, -1: nothing is hit
  bool upright = false;                         ///< a wall, a column or the like; else a floor, a ceiling or a slope
  Eigen::Vector2d n = Eigen::Vector2d::Zero();  ///< unit normal towards the ray's origin, of an upright face
};

/// A ray of the sensor: horizontal unit direction in I and rise per horizontal metre.
struct SensorRay {
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();
  double slope = 0.0;
};

/// What was built to stay as the plan has it, in I: the same surfaces that the simulated LiDAR and the judge see, but
/// for furniture, panes and leaves.
class Structure {
 public:
  explicit Structure(const bim::BuildingMesh& mesh_I);

  /// First hits of rays from one point up to a range. hits.size() == rays.size(). Neighbouring rays should stand next
  /// to each other.
  void cast(const Eigen::Vector3d& origin_I, std::span<const SensorRay> rays, double range_max_m,
            std::span<StructureHit> hits) const;
  /// Element of a wall or column between two points, or -1.
  [[nodiscard]] int barrier(const Eigen::Vector3d& from_I, const Eigen::Vector3d& to_I) const;
  /// True for an element of three bars or more. Which gap between them a beam passes depends on a centimetre.
  [[nodiscard]] bool is_railing(int element) const { return railing_[static_cast<std::size_t>(element)]; }
  [[nodiscard]] bool is_wall(int element) const { return wall_[static_cast<std::size_t>(element)]; }
  /// Height of what a robot at a point would stand on, none within reach below it. m.
  [[nodiscard]] std::optional<double> ground_below(const Eigen::Vector3d& p_I, double reach_m) const;

 private:
  bim::RayScene scene_;
  std::vector<bool> wall_;     ///< by element
  std::vector<bool> blocks_;   ///< by element: a wall or a column
  std::vector<bool> railing_;  ///< by element
};

}  // namespace plumbline::slam
