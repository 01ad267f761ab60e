// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace plumbline::bim {

/// What an entity is to a building; everything else in the file is left out.
enum class StepClass {
  storey,
  wall,
  opening,
  door,
  window,
  space,
  slab,
  roof,
  column,
  stair,
  stair_flight,
  curtain_wall,
  part,      ///< of a wall or slab that has no body of its own
  obstacle,  ///< any other element; obstacle_kind() gives its kind
  hidden     ///< inside other elements, or no solid: steel in concrete, fasteners, terrain
};

/// Class of an IFC type, IFC2X3 and IFC4; nullopt for types that are known by their supertypes only.
[[nodiscard]] std::optional<StepClass> class_of(std::string_view type);

/// Obstacle::kind of an IFC type: that of a list for those with a better name, otherwise the type's own words, such as
/// flow_terminal for IfcFlowTerminal.
[[nodiscard]] std::string obstacle_kind(std::string_view type);

}  // namespace plumbline::bim
