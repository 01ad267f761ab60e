// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/building/building.h"

namespace plumbline::bim {

/// A building twice: as designed, for estimators, and as it stands, for the sensors. What is in both has one id.
struct Site {
  Building as_planned;
  Building as_built;
  bool has_plan = true;  ///< false: a mere mesh, in which nothing can be localized
};

/// Reads a building with its as-built deviations. Errors as load_building.
[[nodiscard]] Site load_site(const std::string& path);

/// Reads a building, as planned, of any kind this version knows, told by its content: a plan (YAML whose first key is
/// `plan: 1`) or an IFC file.
/// Throws InputError when the file is missing, a directory, empty or of another kind.
[[nodiscard]] Building load_building(const std::string& path);

}  // namespace plumbline::bim
