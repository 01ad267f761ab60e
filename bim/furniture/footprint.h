// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "bim/model/building.h"

namespace plumbline::bim {

/// What something covers seen from above, as convex parts: corners counter-clockwise, or the two ends of a line.
struct Footprint {
  std::vector<Polygon2> parts;
  Eigen::AlignedBox2d box;

  void add(Polygon2 convex);
};

/// Rectangle of the given size around `at`, turned by yaw, rad.
[[nodiscard]] Polygon2 turned_rectangle(const Eigen::Vector2d& at, const Eigen::Vector2d& size, double yaw);
[[nodiscard]] Footprint footprint_of(Polygon2 convex);
/// What of a solid lies between two heights, m; no parts where nothing does. The convex hull where that covers little
/// more than the solid, else the solid's triangles.
[[nodiscard]] Footprint footprint_of(const Solid& solid, double z0_m, double z1_m);

/// Turned by yaw, rad, about a point, then moved.
[[nodiscard]] Footprint moved(Footprint footprint, const Eigen::Vector2d& about, double yaw, const Eigen::Vector2d& by);

/// Distance of p to the nearest part, m, 0 inside.
[[nodiscard]] double distance(const Footprint& footprint, const Eigen::Vector2d& p);
/// True where the two come nearer than the gap, m, or overlap.
[[nodiscard]] bool nearer_than(const Footprint& a, const Footprint& b, double gap_m);
[[nodiscard]] bool nearer_than(const Polygon2& convex_a, const Polygon2& convex_b, double gap_m);

}  // namespace plumbline::bim
