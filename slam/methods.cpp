// SPDX-License-Identifier: Apache-2.0
#include "slam/methods.h"

#include <array>

#include "slam/baseline/odometry_method.h"
#include "slam/baseline/vgicp_method.h"

namespace plumbline::slam {

std::span<const MethodRow> methods() {
  static const std::array rows = {
      MethodRow{"odometry", "dead reckoning of the legs", false, make_odometry_method},
      MethodRow{"vgicp", "LiDAR odometry: voxelized GICP against a sliding local map", false, make_vgicp_method},
  };
  return rows;
}

const MethodRow* find_method(std::string_view name) {
  for (const MethodRow& row : methods())
    if (row.name == name) return &row;
  return nullptr;
}

}  // namespace plumbline::slam
