// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "scenarios/localizability/floor.h"

namespace plumbline::scenarios {

struct IdentifyMapInput {
  const bim::RayScene* as_planned = nullptr;
  const bim::RayScene* as_built = nullptr;
  std::vector<IdentifyStorey> storeys;  ///< of the building, all
  std::vector<Floor> floors;            ///< those asked about
  double step_m = 0.5;                  ///< of the floors' cells
  bool across = false;                  ///< twins on other storeys count: the storey is not told
  bool compass_only = false;            ///< twins that a compass tells apart are not looked for
  int threads = 1;
};

/// A place that one look cannot tell from a cell: the image of the cell under an isometry of IdentifyMap.
struct CellTwin {
  std::size_t isometry = 0;
  double llr = 0.0;  ///< of the one look
};

/// What can be known in a cell, with or without a compass.
struct CellAnswer {
  int twins = 0;                 ///< places that one look leaves
  std::optional<double> walk_m;  ///< until none is left: 0 where one look suffices, absent where no walk does
};

struct MapCell {
  std::size_t floor = 0;
  Eigen::Vector2d p_W = Eigen::Vector2d::Zero();
  std::vector<CellTwin> twins;
  std::optional<CellAnswer> unknown;  ///< heading not known; absent when only a compass was asked for
  CellAnswer compass;                 ///< heading known within known_yaw_deg
};

/// Where in a building a LiDAR can tell where it is.
struct IdentifyMap {
  std::vector<MapCell> cells;    ///< by floor, then as its cells
  std::vector<Pose> isometries;  ///< twin = isometry * pose
};

/// Twins of every cell by one look, and the walk after which none is left: the shortest one such that along the
/// shortest ways over the floor from cell to cell, with one look in each, the accumulated log-likelihood ratio against
/// every twin, carried along by the same motion, has exceeded drop_llr. A walk stays on its storey. No result depends
/// on `threads`. Throws InputError when there are more than 10,000 cells.
[[nodiscard]] IdentifyMap identify_map(const IdentifyMapInput& input);

}  // namespace plumbline::scenarios
