// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bim/config/tree.h"
#include "bim/load/load.h"
#include "scenarios/localizability/localizability_map.h"

namespace plumbline::scenarios {

struct BuildingMapOptions {
  std::optional<std::string> storey;  ///< id or name; absent: every storey with rooms, or with walls where none has
  double step_m = 0.5;
  bool across = false;
  bool compass_only = false;
  int threads = 1;
};

/// The map of a building with the floors it was made of.
struct BuildingMap {
  BuildingMapOptions options;
  std::vector<Floor> floors;
  IdentifyMap map;
};

/// What the planned building lets be known to a LiDAR that walks through the one as built. Throws InputError.
[[nodiscard]] BuildingMap map_of(const bim::Site& site, const BuildingMapOptions& options);

/// How much of a floor, or of a room, lets what be known.
struct MapShare {
  int cells = 0;
  int one_look = 0;
  int walk = 0;
  int never = 0;
  double walk_median_m = 0.0;  ///< of those that need a walk
  double walk_max_m = 0.0;
  int twins_max = 0;
};
/// Of the cells that `of(cell)` counts. `compass`: with the heading known.
[[nodiscard]] MapShare share_of(const BuildingMap& map, bool compass, const std::function<bool(const MapCell&)>& of);

/// As pages call it.
[[nodiscard]] std::string name_of(const bim::Storey& storey);

/// identify --json: {step_m, across, storeys: [{id, unknown: {cells, one_look, walk, never, ...}, compass: {...}}],
/// rooms: [...], cells: [...]}
[[nodiscard]] Tree identify_json(const bim::Site& site, const BuildingMap& map);
/// A line a storey and condition.
[[nodiscard]] std::string identify_text(const bim::Site& site, const BuildingMap& map);
/// One self-contained page with a map a storey and condition.
[[nodiscard]] std::string identify_page(const bim::Site& site, const std::string& name, const BuildingMap& map);

}  // namespace plumbline::scenarios
