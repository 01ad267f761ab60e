// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/far_surfaces.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "bim/median.h"

namespace plumbline::slam {

double median_range(const DeskewedScan& scan) {
  constexpr std::size_t stride = 8;
  std::vector<double> ranges;
  for (std::size_t i = 0; i < scan.range_m.size(); i += stride)
    if (scan.range_m[i] > 0.0) ranges.push_back(scan.range_m[i]);
  return ranges.empty() ? 0.0 : upper_median(std::move(ranges));
}

double median_distance(std::span<const Surfel> surfels) {
  std::vector<double> distances_m;
  distances_m.reserve(surfels.size());
  for (const Surfel& surfel : surfels) distances_m.push_back(surfel.mean_R.norm());
  return distances_m.empty() ? 0.0 : upper_median(std::move(distances_m));
}

std::vector<Eigen::Vector3d> within(std::vector<Eigen::Vector3d> points_R, double far_m) {
  std::erase_if(points_R, [&](const Eigen::Vector3d& p_R) { return p_R.norm() > far_m; });
  return points_R;
}

std::vector<Surfel> without_few_far(std::vector<Surfel> surfels, double far_m) {
  constexpr double least_share = 0.1;  // assumed; 0.9 in a bare hall of 100 x 80 m
  const auto is_far = [&](const Surfel& surfel) { return surfel.mean_R.norm() > far_m; };
  const auto far = std::count_if(surfels.begin(), surfels.end(), is_far);
  if (static_cast<double>(far) < least_share * static_cast<double>(surfels.size())) std::erase_if(surfels, is_far);
  return surfels;
}

}  // namespace plumbline::slam
