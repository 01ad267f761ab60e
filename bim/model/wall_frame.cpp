// SPDX-License-Identifier: Apache-2.0
#include "bim/model/wall_frame.h"

#include <algorithm>

namespace plumbline::bim {

std::vector<Solid> solids_of(const Opening& opening) {
  std::vector<Solid> solids;
  if (opening.solid) solids.push_back(*opening.solid);
  solids.insert(solids.end(), opening.parts.begin(), opening.parts.end());
  return solids;
}

Interval extent_across(const WallFrame& frame, const std::vector<Solid>& solids) {
  Interval y;
  for (const Solid& solid : solids)
    for (const Eigen::Vector3d& p_W : solid.vertices) y.add(frame.to_wall(p_W).y());
  return y;
}

Interval depth_in_wall(const Opening& opening, const Wall& wall) {
  const Interval whole{wall.offset_m, wall.offset_m + wall.thickness_m};
  const Interval own = extent_across(WallFrame(wall), solids_of(opening));
  const Interval depth{std::max(whole.low, own.low), std::min(whole.high, own.high)};
  return depth.length() > 0.0 ? depth : whole;
}

std::vector<Polygon2> projected(const WallFrame& frame, const std::vector<Solid>& solids) {
  std::vector<Polygon2> triangles;
  for (const Solid& solid : solids) {
    const std::vector<Eigen::Vector3d> points = frame.to_wall(solid.vertices);
    for (const Eigen::Vector3i& t : solid.triangles) {
      Polygon2& triangle = triangles.emplace_back();
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d& p = points[static_cast<std::size_t>(t[i])];
        triangle.emplace_back(p.x(), p.z());
      }
    }
  }
  return triangles;
}

}  // namespace plumbline::bim
