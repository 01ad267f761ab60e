// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bim/geometry/plane.h"

namespace plumbline::slam {

struct SacPlane {
  Plane plane;
  std::vector<std::uint32_t> inliers;  ///< indices of points, ascending
};

/// The plane of most points by pcl::SACSegmentation, fitted to its inliers, which are then chosen anew. Its draws are
/// PCL's own: the same for the same number of points. Nothing where no plane is found.
[[nodiscard]] std::optional<SacPlane> sac_plane(std::span<const Eigen::Vector3d> points, double distance_m,
                                                int iterations, double confidence);

}  // namespace plumbline::slam
