// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "bim/model/building.h"

namespace plumbline::bim {

/// Tolerances of cutting and meshing, m.
struct MeshConfig {
  double face_m = 1e-3;    ///< a vertex lies on a wall face, or at a wall end
  double depth_m = 2e-3;   ///< an opening that stops this much before a face still goes through
  double margin_m = 1e-2;  ///< overhang of a 3D cutter beyond the face it pierces
  double grid_m = 1e-6;    ///< grid of the finished vertices; finer than the 2D grid, so that oblique walls stay flat
  double weld_m = 1e-5;    ///< grid of bodies whose vertices came unjoined, and of 3D cuts
};

/// A wall that the 2D method does not take, and why.
struct Refusal {
  WarningKind kind;  ///< not_prismatic | niche
  std::string text;
  std::vector<std::string> more = {};  ///< texts of the same kind about further openings
};

/// Cuts a wall in its elevation: silhouettes of the openings are subtracted from the wall's, and the rest is extruded
/// through the thickness, between the two faces (a prismatic wall, whose ends may be mitred, and openings straight
/// through it). An empty solid when nothing is left of the wall.
[[nodiscard]] std::variant<Solid, Refusal> cut_in_elevation(const Wall& wall, const std::vector<Opening>& openings,
                                                            const MeshConfig& config);

/// A cut wall and the compromises made for it.
struct CutWall {
  Solid solid;  ///< canonical
  bool closed = true;
  std::vector<Warning> warnings;
};

/// Cuts in the elevation where the wall is prismatic, by corefinement of the solids otherwise.
[[nodiscard]] CutWall cut_wall(const Wall& wall, const std::vector<Opening>& openings, const MeshConfig& config);

}  // namespace plumbline::bim
