// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/straight_opening.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "bim/geometry/polygon_boolean.h"
#include "bim/mesh/solid.h"
#include "bim/model/body_section.h"

namespace plumbline::bim {
namespace {

/// Between two planes square to y, with all else parallel to it.
bool is_prism(const Solid& solid, const WallFrame& frame, double tolerance_m) {
  const std::vector<Eigen::Vector3d> points = frame.to_wall(solid.vertices);
  const Interval y = extent_across(frame, {solid});
  const auto on = [&](int i, double at) {
    return std::abs(points[static_cast<std::size_t>(i)].y() - at) <= tolerance_m;
  };
  return std::all_of(solid.triangles.begin(), solid.triangles.end(), [&](const Eigen::Vector3i& t) {
    if (!std::all_of(t.data(), t.data() + 3, [&](int i) { return on(i, y.low) || on(i, y.high); })) return false;
    for (const double at : {y.low, y.high})
      if (on(t[0], at) && on(t[1], at) && on(t[2], at)) return true;
    const auto p = [&](int k) { return points[static_cast<std::size_t>(t[k])]; };
    const Eigen::Vector3d n = (p(1) - p(0)).cross(p(2) - p(0));
    return std::abs(n.y()) * (y.high - y.low) <= tolerance_m * n.norm();
  });
}

/// Middles of the stretches of y between which no solid has a vertex.
std::vector<double> depths_between(const std::vector<Solid>& solids, const WallFrame& frame, const Interval& y,
                                   double tolerance_m) {
  std::vector<double> levels = {y.low, y.high};
  for (const Solid& solid : solids)
    for (const Eigen::Vector3d& p_W : solid.vertices)
      if (const double at = frame.to_wall(p_W).y(); at > y.low + tolerance_m && at < y.high - tolerance_m)
        levels.push_back(at);
  std::sort(levels.begin(), levels.end());
  std::vector<double> depths;
  for (std::size_t i = 0; i + 1 < levels.size(); ++i)
    if (levels[i + 1] - levels[i] > tolerance_m) depths.push_back(0.5 * (levels[i] + levels[i + 1]));
  return depths;
}

/// Section of solids across y, in the wall's elevation.
Region2 section_at(const std::vector<Solid>& solids, const WallFrame& frame, double y) {
  Solid lying;  // with y turned down
  for (const Solid& solid : solids) {
    const int first = static_cast<int>(lying.vertices.size());
    for (const Eigen::Vector3d& p : frame.to_wall(solid.vertices)) lying.vertices.emplace_back(p.x(), p.z(), -p.y());
    for (const Eigen::Vector3i& t : solid.triangles) lying.triangles.emplace_back(t.array() + first);
  }
  return body_section(lying, -y);
}

double perimeter(const Region2& region) {
  double sum = 0.0;
  for (const PolygonWithHoles2& piece : region)
    for (std::size_t i = 0; i < piece.outer.size(); ++i)
      sum += (piece.outer[(i + 1) % piece.outer.size()] - piece.outer[i]).norm();
  return sum;
}

}  // namespace

bool goes_straight_through(const std::vector<Solid>& solids, const WallFrame& frame, const Interval& y,
                           const MeshConfig& config) {
  const auto reaches = [&](const Interval& depth) {
    return depth.low <= y.low + config.depth_m && depth.high >= y.high - config.depth_m;
  };
  if (!reaches(extent_across(frame, solids))) return false;
  if (std::all_of(solids.begin(), solids.end(), [&](const Solid& solid) {
        return reaches(extent_across(frame, {solid})) && is_prism(solid, frame, config.face_m);
      }))
    return true;
  if (!std::all_of(solids.begin(), solids.end(),
                   [&](const Solid& solid) { return is_closed(welded(solid, config.weld_m)); }))
    return true;
  // Between two vertices sides are straight, so that a side aslant falls short of the silhouette in the middle.
  constexpr std::size_t most_depths = 24;
  const std::vector<double> depths = depths_between(solids, frame, y, config.depth_m);
  if (depths.size() > most_depths) return false;
  const Region2 silhouette = unite(projected(frame, solids));
  const double least = area(silhouette) - config.face_m * perimeter(silhouette);
  return std::all_of(depths.begin(), depths.end(),
                     [&](double at) { return area(section_at(solids, frame, at)) >= least; });
}

}  // namespace plumbline::bim
