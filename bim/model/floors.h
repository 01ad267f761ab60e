// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/geometry/polygon.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// What a piece of floor is known from, surest first.
enum class FloorSource {
  slab,      ///< the top of a slab
  obstacle,  ///< the top of a ramp, a footing or a floor covering
  room,      ///< no slab under a room: its own lower end
  walls,     ///< neither slabs nor rooms on the storey: everything within its walls, at its elevation
};

/// A level or sloping face on which one can stand.
struct FloorPiece {
  FloorSource source = FloorSource::slab;
  int element = -1;  ///< index into Building::slabs, obstacles or rooms; -1 for walls
  int storey = -1;
  PolygonWithHoles2 polygon;                        ///< on the plan
  double z0_m = 0.0;                                ///< height over the plan's origin; of a level piece everywhere
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< rise per metre along x and along y

  /// Height in W over a point of the plan, m.
  [[nodiscard]] double z_at(const Eigen::Vector2d& p) const { return z0_m + slope.dot(p); }
};

struct FloorConfig {
  double steepest = 0.40;      ///< tangent; a steeper face is no floor
  double level = 2e-3;         ///< ... and a flatter one is level
  double headroom_m = 0.5;     ///< nothing stands under another piece that is less than this above
  double sunken_m = 0.6;       ///< a floor may lie this much below its storey's elevation, or its room's lower end
  double at_room_m = 0.35;     ///< a piece this close to a room's lower end is that room's floor
  double covered_share = 0.5;  ///< a room with less of its area on such pieces has no slab
  double least_m2 = 0.01;      ///< smaller pieces are left out
  double covering_m = 0.35;  ///< a thicker covering is none of a floor; screed on insulation takes up to 0.2 m, assumed
  double least_covering_m2 = 0.5;  ///< a smaller one is a skirting board or a mat,
  double covering_share = 0.1;     ///< and so is one that covers less of the rectangle around it; both assumed
  double foot_m = 0.08;            ///< a room begins this near above or below a floor covering, or within it
};

/// Whether a covering lies where a floor does: it is flat, and the lower end of a room above it, or its storey's
/// elevation where that has no rooms, meets it. What hangs under a ceiling does not.
[[nodiscard]] bool is_floor_covering(const Building& building, const Obstacle& obstacle,
                                     const FloorConfig& config = {});

/// The floors of all storeys, by (storey, height, outline): the upward faces of slabs, ramps, footings and floor
/// coverings, each as high as it is, so that split levels, raised and sunken floors, mezzanines and ramps lie where
/// they are and not at their storey's elevation. A piece belongs to the storey of the room it is the floor of,
/// otherwise to the highest habitable storey that begins no more than sunken_m above it. What lies under another piece
/// without headroom, or inside another slab, is cut away; so where two pieces of a storey overlap on the plan one can
/// stand on both. Whether a robot gets from one piece to the next is not looked at.
[[nodiscard]] std::vector<FloorPiece> floor_pieces(const Building& building, const FloorConfig& config = {});

/// Thin slabs for storeys that have none, so that a LiDAR sees what a robot stands on: under their rooms, without rooms
/// from wall to wall and beyond_m farther (assumed: a walk goes round outside). None in buildings with stairs, whose
/// wells they would close.
[[nodiscard]] std::vector<Slab> assumed_slabs(const Building& building, double beyond_m = 5.0);

}  // namespace plumbline::bim
