// SPDX-License-Identifier: Apache-2.0
#include "sim/route/waypoint.h"

namespace plumbline::sim {

std::vector<Waypoint> on_floor(const std::vector<Eigen::Vector2d>& points_W, double floor_z_W) {
  std::vector<Waypoint> out;
  out.reserve(points_W.size());
  for (const Eigen::Vector2d& p : points_W) out.push_back({{p.x(), p.y(), floor_z_W}, false});
  return out;
}

double length(const std::vector<Waypoint>& way) {
  double sum = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) sum += (way[i].p_W - way[i - 1].p_W).norm();
  return sum;
}

double length_on_stairs(const std::vector<Waypoint>& way) {
  double sum = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i)
    if (way[i].stairs) sum += (way[i].p_W - way[i - 1].p_W).norm();
  return sum;
}

}  // namespace plumbline::sim
