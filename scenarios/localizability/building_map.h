// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bim/config/tree.h"
#include "scenarios/localizability/alike.h"
#include "scenarios/localizability/localizability_map.h"

namespace plumbline::scenarios {

struct BuildingMapOptions {
  std::string file = "building";      ///< that errors name
  std::optional<std::string> storey;  ///< id or name; absent: every storey with rooms, or with walls where none has
  double step_m = 0.5;
  std::optional<double> budget_s;  ///< step_m grows until the map fits into this time on two cores (StepBudget)
  bool across = false;
  bool compass_only = false;
  int threads = 1;
  std::function<void(std::size_t done, std::size_t all)> progress = {};  ///< called as places are done; may be empty
  std::function<void(const std::string&)> phase;  ///< told what is being done, for a person who waits
};

/// The map of a building with the floors it was made of.
struct BuildingMap {
  BuildingMapOptions options;
  std::vector<Floor> floors;
  std::vector<std::size_t> bare;  ///< storeys asked for without a place where the robot can stand
  LocalizabilityMap map;
  AlikePlaces alike;  ///< what looks alike in it, and what distinguishes it
};

/// Where the pose can be known from LiDAR scans of the building as built and its plan. Throws InputError.
[[nodiscard]] BuildingMap map_of(const RunBuilding& building, const BuildingMapOptions& options,
                                 PlanEvidence by = PlanEvidence::building);

/// Both answers for a building.
struct BuildingMaps {
  BuildingMap building;                       ///< by what was built alone
  std::optional<BuildingMap> with_furniture;  ///< absent where nothing planned may have moved: the same
};
[[nodiscard]] BuildingMaps maps_of(const RunBuilding& building, const BuildingMapOptions& options);

/// Shares of the cells of a floor or a room by how the pose can be known there.
struct MapShare {
  int cells = 0;
  int one_scan = 0;
  int walk = 0;
  int never = 0;
  double walk_median_m = 0.0;  ///< of those that need a walk
  double walk_max_m = 0.0;
  int aliases_max = 0;
};
/// Of the cells that `of(cell)` counts. `compass`: with the heading known.
[[nodiscard]] MapShare share_of(const BuildingMap& map, bool compass, const std::function<bool(const MapCell&)>& of);

/// As pages call it.
[[nodiscard]] std::string name_of(const bim::Storey& storey);

/// identify --json: {step_m, across, storeys: [{id, unknown: {cells, one_scan, walk, never, ...}, compass: {...}}],
/// rooms: [...], cells: [...], alike: [{turned_deg, moved_m, places, rooms, element, missing, share, from}]} by the
/// building alone; the same lists again in with_furniture, where that differs. without_places: [id] of storeys, if any.
[[nodiscard]] Tree localizability_json(const RunBuilding& building, const BuildingMaps& maps);
/// Which building the scans are of, a sentence; empty where it is built as planned.
[[nodiscard]] std::string scanned_text(const RunBuilding& building);
/// A table an answer, a line a storey and condition.
[[nodiscard]] std::string localizability_text(const RunBuilding& building, const BuildingMaps& maps);

}  // namespace plumbline::scenarios
