// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/formats/plan_yaml/plan_file.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// Adds the stairs of a checked plan to its finished storeys and cuts their stairwells. A copied storey has the stairs
/// of its source where there is a storey as far above it. Throws InputError at the stair that cannot be walked.
void add_stairs(const PlanFile& plan, const Tree& tree, Building& building);

}  // namespace plumbline::bim
