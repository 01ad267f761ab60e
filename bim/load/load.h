// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/formats/plan_yaml/deviations.h"
#include "bim/model/building.h"
#include "bim/model/building_options.h"

namespace plumbline::bim {

/// A building as planned, for estimators, and as built, for the sensors. Elements that are in both have one id.
struct PlannedAndBuilt {
  Building as_planned;
  Building as_built;
  std::vector<Change> changes;  ///< what differs, as built
  bool has_plan = true;         ///< false: a mesh without a plan, in which no method can localize
};

/// The bytes of a building's file: of a mesh as many as MeshFileConfig allows, of others 1 GiB. Errors as
/// read_text_file().
[[nodiscard]] std::string read_building_file(const std::string& path);

/// Reads a building with its as-built deviations, with a scenario's options, and fills its closed doors and its windows
/// (bim/model/fillings.h). Errors as load_building.
[[nodiscard]] PlannedAndBuilt load_planned_and_built(const std::string& path, const BuildingOptions& options = {});

/// Reads a building, as planned and without fillings, of any supported kind. The content decides: a plan (YAML whose
/// first key is `plan: 1`), a traffic-editor plan (`levels:`) or an IFC file; a mesh is known by its file ending.
/// Throws InputError when the file is missing, a directory, empty or of another kind.
[[nodiscard]] Building load_building(const std::string& path);

}  // namespace plumbline::bim
