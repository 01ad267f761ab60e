// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "bim/model/building.h"

namespace plumbline::bim {

/// Thresholds of reading IFC.
struct IfcConfig {
  double grid_m = 1e-4;           ///< of plan coordinates, elevations and heights
  double layer_match_m = 2e-3;    ///< layer set and body may differ by this much; 714 of 716 walls agree
  double storey_below_m = 0.3;    ///< an element in no storey may begin this much below the one it is given to
  double assumed_height_m = 3.0;  ///< of a top storey without walls and rooms
  double least_storey_m = 2.0;    ///< storeys that the file does not name lie this far apart, at least
  double least_cut_m2 = 1e-3;     ///< an opening in a group of walls belongs to those it cuts more than this out of
  double near_wall_m = 0.25;      ///< a door or window without opening stands in a wall this close to it
  double clear_share = 0.8;       ///< a doorway with less of its width free is opened in the walls that fill it
  double lining_m = 0.13;         ///< a wall this thin at most, along a face of another, lines it
  double lining_gap_m = 0.05;     ///< ... this near to that face
  double least_fill = 0.6;        ///< a wall whose body fills less of its rectangle on the plan is bent or hollow
  double filling_share = 0.5;     ///< ... or in an opening with more than this share of its box
  double headroom_m = 1.2;        ///< that a robot needs over the steps of a stair
  double stair_reach_m = 0.1;     ///< the foot or head of a stair is this close to the floor of its storey
  double stair_foot_m = 0.25;     ///< ... or its foot stands on the slab this far below
};

/// Shapes by which an element of no class of its own is taken for a wall or a floor, where the file has none.
struct LookalikeConfig {
  double least_height_m = 1.8;    ///< of a wall
  double most_thickness_m = 0.6;  ///< of a wall, and of a floor
  double least_length_m = 0.4;    ///< of a wall, which is at least twice as long as thick
  double least_fill = 0.5;        ///< share of its rectangle on the plan that a wall fills
  double least_floor_m2 = 4.0;
  double level_share = 0.7;  ///< of a floor's outline that its upper face covers
};

/// Reads the text of an IFC2X3, IFC4 or IFC4X3 file as a building in W: storeys, walls with uncut bodies, openings,
/// rooms, slabs, columns, and other elements with a body as obstacles. Ids are GlobalIds; every list is sorted by
/// (elevation of the storey, GlobalId). Building::warnings lists the compromises. `file` names the text in errors.
/// Throws InputError with file and line for text that is not a complete IFC file, or in which there is nothing to stand
/// on and nothing to see.
[[nodiscard]] Building read_ifc_text(std::string_view text, const std::string& file, const IfcConfig& config = {});

}  // namespace plumbline::bim
