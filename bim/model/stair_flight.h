// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/model/building.h"

namespace plumbline::bim {

/// Unit direction of ascent, seen from above.
[[nodiscard]] Eigen::Vector2d ascent(const StairFlight& flight);
/// Rectangle of steps first to last of a flight, seen from above, counter-clockwise.
[[nodiscard]] Polygon2 steps_outline(const StairFlight& flight, int first, int last);
/// The point `beyond_m` beyond the last step.
[[nodiscard]] Eigen::Vector2d head_of(const StairFlight& flight, double beyond_m);

}  // namespace plumbline::bim
