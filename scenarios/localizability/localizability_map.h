// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "scenarios/localizability/floor.h"

namespace plumbline::scenarios {

struct LocalizabilityMapInput {
  const bim::RayScene* as_planned = nullptr;
  const bim::RayScene* as_built = nullptr;
  std::span<const char> loose;       ///< as in LocalizabilityInput
  std::span<const Pose> isometries;  ///< as in LocalizabilityInput
  std::vector<SearchArea> storeys;   ///< of the building, all
  std::vector<Floor> floors;         ///< those asked about
  double step_m = 0.5;               ///< of the floors' cells
  bool across = false;               ///< aliases on other storeys count: the storey is unknown
  bool compass_only = false;         ///< aliases that a compass rules out are not searched for
  int threads = 1;
  std::function<void(std::size_t done, std::size_t all)> progress = {};  ///< called as cells are done; may be empty
  const PlaceIndex* index = nullptr;                                     ///< of all storeys; made where it is not given
};

/// Most cells of a map: a scan is 23 kB, twice that where plan and building differ.
inline constexpr std::size_t most_map_cells = 10000;

/// A pose aliased with that of a cell in one scan: the image of the cell under an isometry of LocalizabilityMap.
struct CellAlias {
  std::size_t isometry = 0;
  double llr = 0.0;  ///< of the one scan
};

/// Localizability of a cell, with or without a compass.
struct CellAnswer {
  int aliases = 0;               ///< places that one scan leaves
  std::optional<double> walk_m;  ///< until none is left: 0 where one scan suffices, absent where no walk does
};

struct MapCell {
  std::size_t floor = 0;
  Eigen::Vector2d p_W = Eigen::Vector2d::Zero();
  std::vector<CellAlias> aliases;
  std::optional<CellAnswer> unknown;  ///< heading not known; absent when only a compass was asked for
  CellAnswer compass;                 ///< heading known within known_yaw_deg
};

/// Where in a building a LiDAR can be localized.
struct LocalizabilityMap {
  std::vector<MapCell> cells;    ///< by floor, then as its cells
  std::vector<Pose> isometries;  ///< alias = isometry * pose
  std::uint64_t beams = 0;       ///< the work of making it, as AliasFinder counts it
};

/// The places that such maps compare with.
[[nodiscard]] PlaceIndex index_of(const LocalizabilityMapInput& input);

/// Aliases of every cell by one scan, and the walk after which none is left: the shortest one such that along the
/// shortest ways over the floor from cell to cell, with one scan in each, the accumulated log-likelihood ratio against
/// every alias, carried along by the same motion, has exceeded drop_llr. A walk stays on its storey. No result depends
/// on `threads`. Throws InputError when there are more than most_map_cells, with a step that would do.
[[nodiscard]] LocalizabilityMap compute_localizability_map(const LocalizabilityMapInput& input);

}  // namespace plumbline::scenarios
