// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/load/load.h"
#include "scenarios/spec/scenario.h"

namespace plumbline::scenarios {

/// The building of a run, from its file: with the scenario's options, its generated furniture, as planned and as built
/// alike, and the furniture as built changed by its world. Changed pieces are among the changes: move_furniture,
/// remove_furniture, add_furniture. As built it has a floor where the robot walks on one that no file has
/// (bim::assumed_slabs). The scenario's seed decides how they are changed. Throws InputError.
[[nodiscard]] bim::PlannedAndBuilt load_site(const std::string& path, const Scenario& scenario);

}  // namespace plumbline::scenarios
