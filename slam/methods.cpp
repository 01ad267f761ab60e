// SPDX-License-Identifier: Apache-2.0
#include "slam/methods.h"

#include <array>

#include "slam/baseline/odometry_method.h"
#include "slam/baseline/vgicp_method.h"
#include "slam/localize/s_graph_localization.h"
#include "slam/sgraphs/s_graphs_plus.h"

namespace plumbline::slam {

std::span<const MethodRow> methods() {
  static const std::array rows = {
      MethodRow{"odometry", "dead reckoning of the legs", false, make_odometry_method},
      MethodRow{"vgicp", "LiDAR odometry: voxelized GICP against a sliding local map", false, make_vgicp_method},
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
