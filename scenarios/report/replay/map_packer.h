// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "bim/geometry/pose.h"

namespace plumbline::scenarios {

/// A map cloud fit for viewing.
struct PackedMap {
  std::size_t count = 0;
  double voxel_m = 0.0;  ///< of which one point each is left
  std::string
      bytes;  ///< all x, all y, all z relative to the origin, in cm of 16 bits: all low bytes, then all high ones
};

/// The points in W, of more than 200,000 every so many, thinned to one for each voxel of 0.1 m or as much more as
/// leaves `most`; those further from the origin than 16 bits of cm hold are left out.
[[nodiscard]] PackedMap pack_map(const std::vector<Eigen::Vector3f>& map_F, const Pose& X_WF,
                                 const Eigen::Vector3d& origin, std::size_t most = 20000);

}  // namespace plumbline::scenarios
