// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/geometry/interval.h"

namespace plumbline::slam {

/// What the intervals leave of [low, high], ascending.
[[nodiscard]] std::vector<Interval> rest_of(double low, double high, std::vector<Interval> taken);

}  // namespace plumbline::slam
