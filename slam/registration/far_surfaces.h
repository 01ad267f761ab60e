// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "slam/registration/surfels.h"

namespace plumbline::slam {

/// Median range of every eighth return, m; 0 without any.
[[nodiscard]] double median_range(const DeskewedScan& scan);
/// Median distance of surfels from R, m; 0 without any.
[[nodiscard]] double median_distance(std::span<const Surfel> surfels);
/// Drops rough points beyond far_m, and surfels beyond it where less than a tenth of all are: a few led astray on
/// fields of posts, while those of a hall are its walls.
void drop_few_far(Surfaces& surfaces, double far_m);

}  // namespace plumbline::slam
