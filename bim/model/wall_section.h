// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bim/geometry/interval.h"
#include "bim/model/building.h"

namespace plumbline::bim {

struct WallSectionConfig {
  double step_m = 0.10;     ///< between the places along a wall that are looked at
  double least_fill = 0.6;  ///< a wall whose body fills less of its thickness
  double gap_min_m = 0.3;   ///< over this length
  double mitre_m = 0.5;     ///< away from its ends is not straight
};

/// A stretch of a wall's surface seen from above, in the wall's frame: x along it, y across. Outside is on the left.
struct WallCut {
  Eigen::Vector2d a = Eigen::Vector2d::Zero(), b = Eigen::Vector2d::Zero();
};

/// Where the surface of the wall's uncut body meets the height z, those in line joined. None without a body.
[[nodiscard]] std::vector<WallCut> section(const Wall& wall, double z);

/// Whether the body fills the straight wall between two heights but for mitred ends and its openings: a curved one does
/// not, nor one with a gap. True without a body.
[[nodiscard]] bool is_straight(const Wall& wall, const std::vector<Opening>& openings, const Interval& z,
                               const WallSectionConfig& config = {});

/// The openings of one wall.
[[nodiscard]] std::vector<Opening> openings_of(const Building& building, int wall);

/// Thin walls behind the surface of a wall's body at the height z, as deep as the body but no more than `deepest_m`.
[[nodiscard]] std::vector<Wall> surface_walls(const Wall& wall, double z, double deepest_m);

}  // namespace plumbline::bim
