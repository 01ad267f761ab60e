// SPDX-License-Identifier: Apache-2.0
#include "slam/methods.h"

#include <array>

#include "slam/baseline/lidar_odometry_method.h"
#include "slam/baseline/odometry_method.h"
#include "slam/localize/s_graph_localization.h"
#include "slam/sgraphs/s_graphs_plus.h"

namespace plumbline::slam {

namespace {

template <OdometryKind kind>
std::unique_ptr<Method> odometry_alone(const MethodInput& input) {
  LidarOdometryConfig config;
  config.kind = kind;
  return make_lidar_odometry_method(input, config);
}

}  // namespace

std::span<const MethodRow> methods() {
  static const std::array rows = {
      MethodRow{"odometry", "dead reckoning of the legs", false, make_odometry_method},
      MethodRow{"vgicp", "LiDAR odometry: voxelized GICP against a sliding local map", false,
                odometry_alone<OdometryKind::vgicp>},
      MethodRow{"floam", "LiDAR odometry: edges and planes against a feature map, in the style of F-LOAM", false,
                odometry_alone<OdometryKind::floam>, false},
      MethodRow{"aloam", "LiDAR odometry: scan to scan, then against a feature map, in the style of A-LOAM", false,
                odometry_alone<OdometryKind::aloam>, false},
      MethodRow{"s_graphs_plus", "S-Graphs+: walls, rooms, floors and loops in one four-layered graph", false,
                make_s_graphs_plus_method},
      MethodRow{"s_graph_localization", "particle filter on the plan's walls and rooms, then a graph against them",
                true, [](const MethodInput& input) { return make_s_graph_localization(input); }},
  };
  return rows;
}

const MethodRow* find_method(std::string_view name) {
  for (const MethodRow& row : methods())
    if (row.name == name) return &row;
  return nullptr;
}

}  // namespace plumbline::slam
