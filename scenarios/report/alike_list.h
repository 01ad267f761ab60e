// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scenarios/localizability/building_map.h"

namespace plumbline::scenarios {

/// What looks alike in one condition: with a compass only where headings are alike too.
[[nodiscard]] AlikePlaces shown_alike(const BuildingMap& map, bool compass);

/// A table of the motions by which places look alike: the rooms, how many places, what distinguishes them and from
/// where it is seen.
[[nodiscard]] std::string list_alike(const RunBuilding& building, const AlikePlaces& places);

/// Outlines of the deciding elements on a storey, with their row of the table.
[[nodiscard]] std::string draw_deciding(const RunBuilding& building, const AlikePlaces& places, int storey);

/// "turned by 180° about (6, 2.5)", "moved by 4 m along x".
[[nodiscard]] std::string motion_text(const Pose& transform);

}  // namespace plumbline::scenarios
