// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "slam/registration/surfels.h"

namespace plumbline::slam {

/// Median range of every eighth return, m; 0 without any.
[[nodiscard]] double median_range(const DeskewedScan& scan);
/// Median distance of surfels from R, m; 0 without any.
[[nodiscard]] double median_distance(std::span<const Surfel> surfels);
/// Drops rough points beyond far_m, which are thinner than the step of columns there, and surfels beyond it where less
/// than a tenth of all are: those of a field are of posts in line by chance, those of a hall are its walls.
void drop_few_far(Surfaces& surfaces, double far_m);

}  // namespace plumbline::slam
