// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bim/geometry/interval.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// Frame of a wall: x along a to b from a, y across to the left, z as in W. A leaning wall stands upright in it.
class WallFrame {
 public:
  explicit WallFrame(const Wall& wall)
      : origin_(wall.a), along_(wall.direction()), left_(wall.left()), z0_(wall.z0_m), slope_(wall.slope) {}

  [[nodiscard]] Eigen::Vector3d to_wall(const Eigen::Vector3d& p_W) const {
    const Eigen::Vector2d p = p_W.head<2>() - origin_;
    return {p.dot(along_), p.dot(left_) - slope_ * (p_W.z() - z0_), p_W.z()};
  }
  [[nodiscard]] Eigen::Vector3d to_world(const Eigen::Vector3d& p) const {
    const Eigen::Vector2d q = origin_ + p.x() * along_ + (p.y() + slope_ * (p.z() - z0_)) * left_;
    return {q.x(), q.y(), p.z()};
  }
  [[nodiscard]] std::vector<Eigen::Vector3d> to_wall(const std::vector<Eigen::Vector3d>& points_W) const {
    std::vector<Eigen::Vector3d> points;
    points.reserve(points_W.size());
    for (const Eigen::Vector3d& p_W : points_W) points.push_back(to_wall(p_W));
    return points;
  }

 private:
  Eigen::Vector2d origin_, along_, left_;
  double z0_, slope_;
};

/// All solids of an opening that came from a model; empty for a plain rectangle.
[[nodiscard]] std::vector<Solid> solids_of(const Opening& opening);
/// Extent of solids across the wall.
[[nodiscard]] Interval extent_across(const WallFrame& frame, const std::vector<Solid>& solids);
/// Where an opening lies across its wall, no deeper than the wall: in a curved one that is far less than its extent. Of
/// an opening without solids the wall's extent.
[[nodiscard]] Interval depth_in_wall(const Opening& opening, const Wall& wall);
/// The triangles of solids in the wall's elevation (x, z); their union is the silhouette.
[[nodiscard]] std::vector<Polygon2> projected(const WallFrame& frame, const std::vector<Solid>& solids);

}  // namespace plumbline::bim
