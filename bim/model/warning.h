// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace plumbline::bim {

/// A kind of warning and what it means: one sentence without its full stop.
struct WarningRow {
  std::string_view kind;
  std::string_view doc;
};

/// Every kind of warning that a reader or the mesh gives, by name.
inline constexpr std::array<WarningRow, 67> warning_rows = {{
    {"assumed_doorway", "a gap between two walls in line becomes a doorway with a lintel"},
    {"assumed_floor", "the drawing has no floor; everything within the outer walls gets one"},
    {"assumed_ground", "the ground of the mesh slopes, or as much floor lies below it; its text says what is taken"},
    {"assumed_height", "the file gives no height of the storey; it is taken as 3 m"},
    {"assumed_storey", "the file has no storeys; levels at which walls begin are taken as such"},
    {"assumed_unit", "the file gives no unit of length, or one that cannot be right; its text says what is taken"},
    {"assumed_up", "the mesh does not say which axis is up, and it may not be z; its text says what is taken"},
    {"bad_floor", "the outline of a floor crosses itself or has no area; the floor is left out"},
    {"bent_wall",
     "the body of a wall is bent or hollow on the plan: it becomes a wall for each straight piece, or stays one, of "
     "which plans hold the rectangle around it while the LiDAR and the robot meet its body"},
    {"blocked_door", "another wall or a column stands in a doorway and leaves too little of it free"},
    {"body_of_parts", "the element has no body of its own; those of its parts replace it"},
    {"curved_axis",
     "the axis of a wall is curved; plans hold the wall as straight, while the LiDAR and the robot meet its body"},
    {"dangling", "an entity that the file refers to is not in it; what depends on it is left out"},
    {"door_unresolved", "a door has the same room, or none, on both sides; where it leads is unknown"},
    {"door_without_wall", "a door stands in no wall, as between panels of a curtain wall; its doorway stays open"},
    {"double_space", "another space lies in the same place and is the room; it is left out"},
    {"drawn_twice", "another element of the same class has the same body; one of them is left out"},
    {"empty", "its openings leave nothing of a wall"},
    {"empty_storey", "a storey has no walls, slabs, spaces or stairs; it is left out"},
    {"few_chairs", "the furniture that a scenario adds has fewer chairs than people; only so many sit"},
    {"filling_matched", "a door or window names no opening; it gets the one it stands in"},
    {"geometry", "a part of the element's geometry could not be read; the rest was"},
    {"inferred_room",
     "the room is no space with a body: it is what walls enclose, or the outline of a space without a body"},
    {"layer_mismatch", "the material layers contradict the body of the wall; the body's faces count"},
    {"left_out", "the element is not part of the building model; its text says why"},
    {"makes_no_sense", "the element contradicts IFC; it is left out"},
    {"levels_overlap", "a level is lower than its walls; they reach into the next one"},
    {"niche",
     "an opening does not go through its wall: it is cut in 3D and leads nowhere; that of a door up to 6 cm short is "
     "cut through"},
    {"no_area", "a slab or a column has no area on the plan; it is kept as an obstacle"},
    {"no_axis",
     "a wall has no reference line; its body's longer extent on the plan replaces it, or the wall is left out"},
    {"no_body",
     "the element has no body that can be read; it is left out, unless its outline is or names a room, and an opening "
     "cuts nothing"},
    {"no_flights", "a stair has no steps in its body; it is a solid and cannot be climbed"},
    {"no_global_id", "an element has no GlobalId, or that of another; its number names it"},
    {"no_floor",
     "no slab lies under a storey or some of its rooms; the robot walks at the lower end of the rooms, the LiDAR sees "
     "no floor"},
    {"no_headroom", "a slab lies so low over the steps of a stair that the robot does not pass; it is not climbed"},
    {"no_layers", "a wall has no material layers; offset and thickness are those of its body"},
    {"no_plan", "a mesh has no rooms and walls; plan localization is refused"},
    {"no_rooms", "walls enclose no room over a floor; no walk goes to such a storey"},
    {"no_walls", "a level has no walls; localization uses its other elements"},
    {"not_a_room", "a space is a gross area, lies outside or covers the other spaces; it is left out"},
    {"not_aligned", "a level shares no fiducial with the lowest, or one that does not fit"},
    {"not_clipped", "what a body should be clipped by does not close; the body is larger than designed"},
    {"not_closed", "the surface of a body is not closed; openings of a wall are then cut out of its surface"},
    {"not_cut", "an opening could not be cut out of its wall"},
    {"not_prismatic", "a wall is not an extrusion of its elevation; its openings are cut in 3D"},
    {"odd_size", "the building, its doors or a storey are smaller or larger than any; its unit may be wrong"},
    {"opening_assumed", "a door or window fills no opening; its box is cut out of the wall it stands in"},
    {"opening_unused", "an opening belongs to no element or to one without a body, or misses its wall; nothing is cut"},
    {"other_schema",
     "the file has another version of IFC than IFC2X3 and IFC4, or not the one that it says; the nearer one is used"},
    {"recentred", "the coordinates are those of a map; the building is moved to the origin"},
    {"room_hole", "other rooms stand in a room that walls enclose; its outline goes round them"},
    {"room_pieces", "the outline of a room has several pieces; the largest is the room"},
    {"scale_spread", "the measurements of a level disagree; their mean is used"},
    {"second_filling", "another door or window fills the same opening already"},
    {"see_through", "the LiDAR sees through this material, except at normal incidence"},
    {"several_buildings", "the file has several buildings; their names distinguish their storeys"},
    {"skipped_placement", "the element stands on a grid or alignment that cannot be evaluated; it is left out"},
    {"slab_pieces", "a slab has several pieces; the robot walks on the largest only"},
    {"split_storey", "floors of a storey lie far above each other; each is taken as a storey"},
    {"stair_ends", "the head of a stair reaches the floor of no storey"},
    {"stair_within", "a stair leads from and to the same storey"},
    {"storey_kinds", "no storey has contents; all are taken as habitable"},
    {"storey_moved",
     "the file gives a storey no height, or one at which its floor is not; that of its slabs, spaces or walls counts"},
    {"taken_as_slab", "the storey has no slab; the element lies flat and is taken as one"},
    {"taken_as_wall", "the file has no walls; the element is vertical like one and is read as one"},
    {"unknown_class", "entities of a class that is not read are left out"},
    {"walls_overlap", "a door of one wall stands in another too; the other is opened there"},
}};

/// The name of a row. A name that the table does not hold is an error of the compiler.
class WarningKind {
 public:
  consteval WarningKind(const char* kind) : kind_(kind) {
    if (std::none_of(warning_rows.begin(), warning_rows.end(), [&](const auto& row) { return row.kind == kind_; }))
      throw "not in warning_rows";
  }
  [[nodiscard]] constexpr std::string_view name() const { return kind_; }

 private:
  std::string_view kind_;
};

/// A compromise made while reading an element; listed by `inspect`.
struct Warning {
  Warning(std::string element_id, WarningKind row, std::string sentence)
      : element(std::move(element_id)), kind(row.name()), text(std::move(sentence)) {}

  std::string element;  ///< id of the element, empty for the whole file
  std::string kind;     ///< of warning_rows
  std::string text;
};

}  // namespace plumbline::bim
