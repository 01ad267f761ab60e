// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/mesh/mesh.h"

namespace plumbline::scenarios {

/// Throws InputError where a building reaches so far that grids over all of it would take more than 1 GB.
void check_extent(const bim::BuildingMesh& mesh);

}  // namespace plumbline::scenarios
