// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/formats/plan_yaml/deviations.h"
#include "bim/model/building.h"
#include "bim/model/building_options.h"

namespace plumbline::bim {

/// A building twice: as designed, for estimators, and as it stands, for the sensors. What is in both has one id.
struct Site {
  Building as_planned;
  Building as_built;
  std::vector<Change> changes;  ///< what differs, as built
  bool has_plan = true;         ///< false: a mere mesh, in which nothing can be localized
};

/// Reads a building with its as-built deviations, as a scenario wants it, and fills its closed doors and its windows
/// (bim/building/fillings.h). Errors as load_building.
[[nodiscard]] Site load_site(const std::string& path, const BuildingOptions& options = {});

/// Reads a building, as planned and without fillings, of any kind this version knows, told by its content: a plan (YAML
/// whose first key is `plan: 1`), a traffic-editor plan (`levels:`) or an IFC file; and a mesh, told by its ending.
/// Throws InputError when the file is missing, a directory, empty or of another kind.
[[nodiscard]] Building load_building(const std::string& path);

}  // namespace plumbline::bim
