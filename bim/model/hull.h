// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/geometry/polygon.h"

namespace plumbline::bim {

/// Smallest convex polygon around points, counter-clockwise; empty for fewer than three distinct ones.
[[nodiscard]] Polygon2 convex_hull(Polygon2 points);

/// A rectangle by its middle line a to b, along the longer sides, and its width across.
struct ThinRectangle {
  Eigen::Vector2d a = Eigen::Vector2d::Zero(), b = Eigen::Vector2d::Zero();
  double width_m = 0.0;
};

/// The rectangle of least width around a convex polygon; one of its sides lies on an edge. All zero for fewer than
/// three corners.
[[nodiscard]] ThinRectangle thinnest_rectangle(const Polygon2& hull);

}  // namespace plumbline::bim
