// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "bim/model/building.h"

namespace plumbline::bim {

/// Dimensions that a traffic-editor plan does not give, and how its drawing becomes a building.
struct TrafficEditorConfig {
  double wall_height_m = 2.5;      ///< as rmf_building_map_tools builds walls
  double wall_thickness_m = 0.1;   ///< as rmf_building_map_tools builds walls
  double door_height_m = 2.1;      ///< the file gives none; a plan's default
  double slab_m = 0.2;             ///< thickness of floor and ceiling; a plan's default
  double doorway_max_m = 2.0;      ///< two wall ends in line this close leave a doorway between them
  double side_gap_max_m = 1.5;     ///< so do a wall's end and the wall straight ahead of it
  double touching_m = 0.15;        ///< a smaller gap is a drawing error
  double in_line = 0.18;           ///< sine of the angle between collinear walls and doors (10 degrees)
  double on_wall_m = 0.15;         ///< a door this near to a wall's line is in that wall
  double lowest_room_m = 2.0;      ///< the least height between two levels
  double least_span_m = 0.01;      ///< a door that reaches less far into a wall does not open it
  double least_in_walls = 0.5;     ///< share of a door in walls, from which on it opens them; one in less spans a gap
  double scale_spread = 0.02;      ///< measurements of a level may differ by this share before a warning
  double fiducial_m = 0.3;         ///< levels may be this far out of line at a fiducial before a warning
  double furthest_m = 1e5;         ///< coordinates beyond this are refused
  double least_floor = 0.5;        ///< share of a recovered room that a floor carries; less is a shaft
  std::size_t most_items = 20000;  ///< vertices, walls or doors of a level
  std::size_t most_bytes = std::size_t{1} << 26U;
};

/// Reads a traffic-editor plan (`.building.yaml`, known by its top key `levels:`): walls, doors, floors and levels,
/// in W with y up, the lowest level's drawing the origin, m by the measurements; further levels are laid on it by
/// their common fiducials. Doors open the walls they stand in or close the gap they span; other gaps between walls in
/// line become doorways. Rooms are what walls enclose over a floor. Lifts and models are left out with a warning.
/// Throws InputError at the offending line.
[[nodiscard]] Building read_traffic_editor_text(std::string_view text, const std::string& file,
                                                const TrafficEditorConfig& config = {});

}  // namespace plumbline::bim
