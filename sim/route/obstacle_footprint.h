// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "bim/geometry/interval.h"
#include "bim/model/building.h"
#include "sim/route/route.h"

namespace plumbline::sim {

struct Segment2 {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
};

/// Stretch of a wall that can be walked through: from s0 to s1 along it, and as deep as its opening, since one wall may
/// go round a room and have another side opposite.
struct Gap {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d e = Eigen::Vector2d::UnitX();  ///< unit
  double s0 = 0.0;
  double s1 = 0.0;
  Interval across = {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};

  [[nodiscard]] Eigen::Vector2d left() const { return {-e.y(), e.x()}; }
  [[nodiscard]] bool holds(const Eigen::Vector2d& p) const {
    const double s = e.dot(p - a), t = left().dot(p - a);
    return s > s0 && s < s1 && t > across.low && t < across.high;
  }
};

/// One element as seen from above at the robot's height.
struct ObstacleFootprint {
  std::string name;                             ///< as messages call it: "wall 'w1'"
  std::vector<Segment2> edges;                  ///< of everything between the band's heights
  std::vector<std::vector<Segment2>> sections;  ///< closed outlines at some heights; inside (even-odd) is solid
  std::vector<Gap> gaps;                        ///< no section is solid here; the edges are cut already
};

/// Footprints of all obstacles on a floor at z = floor_z, in canonical order.
[[nodiscard]] std::vector<ObstacleFootprint> find_obstacle_footprints(const bim::Building& building, double floor_z,
                                                                      const RouteConfig& config);

/// Convex outlines of furniture of which only the surface is an obstacle, up to RouteConfig::furniture_max_m2.
[[nodiscard]] std::vector<Polygon2> hollow_obstacles(const bim::Building& building, double floor_z,
                                                     const RouteConfig& config);

}  // namespace plumbline::sim
