// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "slam/registration/surfels.h"

namespace plumbline::slam {

/// Median range of every eighth return, m; 0 without any.
[[nodiscard]] double median_range(const DeskewedScan& scan);
/// Median distance of surfels from R, m; 0 without any.
[[nodiscard]] double median_distance(std::span<const Surfel> surfels);
/// Those up to far_m from R.
[[nodiscard]] std::vector<Eigen::Vector3d> within(std::vector<Eigen::Vector3d> points_R, double far_m);
/// Without surfels beyond far_m where less than a tenth of all are: a few led astray on fields of posts, while those of
/// a hall are its walls.
[[nodiscard]] std::vector<Surfel> without_few_far(std::vector<Surfel> surfels, double far_m);

}  // namespace plumbline::slam
