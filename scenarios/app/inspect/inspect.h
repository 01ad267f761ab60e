// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/config/tree.h"
#include "bim/formats/plan_yaml/deviations.h"
#include "bim/mesh/mesh.h"
#include "bim/model/building.h"

namespace plumbline::scenarios {

/// What `inspect --json` prints: {hash, schema, unit, storeys, walls, rooms, doors, windows, openings, slabs, columns,
/// stairs, obstacles, adjacency, symmetry, warnings}. Each element has id, step_id (IFC), storey (its id), volume_m3,
/// closed and bbox [[x, y, z], [x, y, z]] in W, m; a wall its two faces {n, d}; a room polygon, faces and area_m2.
/// `mesh` is that of `building`. An opening's volume and box are those of the hole as given, before it is cut to its
/// wall.
[[nodiscard]] Tree inspect_json(const bim::Building& building, const bim::BuildingMesh& mesh);

/// The same for people: storeys with counts, rooms with areas and neighbours, solids by kind, `changes` (what is not as
/// planned), warnings by kind, totals.
[[nodiscard]] std::string inspect_text(const bim::Building& building, const bim::BuildingMesh& mesh,
                                       const std::vector<bim::Change>& changes);

}  // namespace plumbline::scenarios
