// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/geometry/polygon.h"

namespace plumbline::slam {

/// True for a polygon, counter-clockwise, that turns left or goes straight at every vertex.
[[nodiscard]] bool is_convex(const Polygon2& polygon);

/// Area that two simple counter-clockwise polygons share, m^2. Where one of them is convex, as most rooms are, the
/// other is clipped in doubles (1e-9 m^2 on rooms); else the exact booleans of bim/geometry, which take a thousand
/// times as long.
[[nodiscard]] double overlap_area(const Polygon2& a, const Polygon2& b);

}  // namespace plumbline::slam
