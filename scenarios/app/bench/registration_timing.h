// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bim/geometry/pose.h"

/// Our registration of two clouds against PCL's, on real scans.
namespace plumbline::scenarios {

/// What one registration gave and cost.
struct Registered {
  Pose X_TS;
  double cpu_ms = 0.0;
};

/// Both thin the clouds, find their normals or covariances and match them, from the identity.
[[nodiscard]] Registered register_ours(const std::vector<Eigen::Vector3f>& target_T,
                                       const std::vector<Eigen::Vector3f>& source_S);
/// Voxels of 0.25 m and PCL's GICP at its defaults, one thread.
[[nodiscard]] Registered register_pcl(const std::vector<Eigen::Vector3f>& target_T,
                                      const std::vector<Eigen::Vector3f>& source_S);

}  // namespace plumbline::scenarios
