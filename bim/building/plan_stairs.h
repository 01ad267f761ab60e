// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/building/building.h"
#include "bim/building/plan_file.h"

namespace plumbline::bim {

/// Adds the stairs of a checked plan to its finished storeys and cuts their stairwells. A copied storey has the stairs
/// of its source where there is a storey as far above it. Throws InputError at the stair that cannot be walked.
void add_stairs(const PlanFile& plan, const Tree& tree, Building& building);

}  // namespace plumbline::bim
