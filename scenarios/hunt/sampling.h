// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/random/stream.h"
#include "scenarios/hunt/hunt_file.h"

namespace plumbline::scenarios {

/// A point of the unit cube, a number in [0, 1) for each thing that is drawn.
using Point = std::vector<double>;

/// Latin hypercube [mckay1979]: of `count` points each has, in every dimension, one of as many equal intervals to
/// itself.
[[nodiscard]] std::vector<Point> latin_hypercube(std::size_t count, std::size_t dimensions, const Stream& stream);

/// A point near another: each number moves by a Gauss of this standard deviation, turned back at 0 and 1. `tick` tells
/// one draw from another.
[[nodiscard]] Point near_point(const Point& point, double sigma, const Stream& stream, std::uint64_t tick);

/// The value of a range at u in [0, 1), as it stands in a scenario. Numbers have four digits after the first.
[[nodiscard]] std::string value_at(const HuntRange& range, double u);

}  // namespace plumbline::scenarios
