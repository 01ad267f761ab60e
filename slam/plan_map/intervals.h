// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

namespace plumbline::slam {

using Interval = std::array<double, 2>;  ///< from, to

/// What the intervals leave of [low, high], ascending.
[[nodiscard]] std::vector<Interval> rest_of(double low, double high, std::vector<Interval> taken);

}  // namespace plumbline::slam
