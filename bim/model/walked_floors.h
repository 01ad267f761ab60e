// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/model/building.h"
#include "bim/model/floors.h"

namespace plumbline::bim {

/// Floors of a storey that the robot can stand on though they do not lie at its elevation.
struct WalkedFloorConfig {
  double level_m = 0.05;                     ///< no higher or lower than this is the storey's own floor
  double highest_m = 1.2;                    ///< above its elevation
  double lowest_m = FloorConfig().sunken_m;  ///< below it
  double bare_slab_m = 0.35;   ///< a slab up to this far below a room may have a covering that was not drawn
  double sunken_min_m2 = 1.0;  ///< a smaller sunken floor is a pit or a drain
  double steepest = 0.2;       ///< tangent of a sloping floor that is walked; wheelchairs have 0.06 to 0.1, cars 0.15
  double slope_min_m = 0.05;   ///< a floor that rises less from end to end is level
  double doorway_m = 0.05;     ///< the threshold of a door this near in height belongs to the raised floor,
  double beside_m = 0.35;      ///< and this near to it on the plan
};

/// Floor above a storey's ground level. Heights are in the frame of the plan: W, unless it was moved.
struct RaisedFloor {
  PolygonWithHoles2 polygon;                        ///< on the plan
  double z_m = 0.0;                                 ///< of its highest point
  double z0_m = 0.0;                                ///< over the plan's origin
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< rise per metre along x and along y
  int obstacle = -1;                                ///< the ramp or floor covering that it is the top of, -1: none

  [[nodiscard]] bool is_level() const { return slope.isZero(0.0); }
  /// Height over a point of the plan, m.
  [[nodiscard]] double z_at(const Eigen::Vector2d& p) const { return z0_m + slope.dot(p); }
};

/// What the robot walks on in a storey.
struct WalkedFloors {
  double ground_m = 0.0;            ///< height of the lowest: the elevation, unless a level slab of a room lies lower
  std::vector<RaisedFloor> raised;  ///< by highest point, with the thresholds of open doors that lead to them

  [[nodiscard]] double highest_m() const { return raised.empty() ? ground_m : raised.back().z_m; }
};
/// Height over a point of the plan, m; where several floors lie above each other, of the highest.
[[nodiscard]] double height_at(const WalkedFloors& floors, const Eigen::Vector2d& p);
/// Floors moved by a rotation about z and a translation: p_V = X_VW p_W.
[[nodiscard]] WalkedFloors moved(const Pose& X_VW, WalkedFloors floors);
/// Those of a storey of the building.
[[nodiscard]] WalkedFloors walked_floors(const Building& as_built, int storey, const WalkedFloorConfig& config = {});

}  // namespace plumbline::bim
