// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/geometry/polygon.h"

namespace plumbline::bim {

/// Smallest convex polygon around points, counter-clockwise; empty for fewer than three distinct ones.
[[nodiscard]] Polygon2 convex_hull(Polygon2 points);

}  // namespace plumbline::bim
