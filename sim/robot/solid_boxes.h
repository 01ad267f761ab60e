// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "bim/model/building.h"
#include "sim/robot/collision.h"

namespace plumbline::sim {

/// Heights in W, m.
struct HeightRange {
  double from = 0.0;
  double to = 0.0;
};

[[nodiscard]] inline bool overlap(const HeightRange& a, const HeightRange& b) { return a.from < b.to && b.from < a.to; }

/// Box over a rectangle whose x axis points along `yaw`.
[[nodiscard]] CollisionBox upright_box(const Eigen::Vector2d& center, double yaw, const Eigen::Vector2d& half,
                                       const HeightRange& z);

/// The smallest upright box over points whose x axis points along `yaw`. points must not be empty.
[[nodiscard]] CollisionBox box_along(const std::vector<Eigen::Vector2d>& points, double yaw, const HeightRange& z);

/// The smallest upright box over points, its direction one of 36 (ties: the first). points must not be empty.
[[nodiscard]] CollisionBox bounding_box(const std::vector<Eigen::Vector2d>& points, const HeightRange& z);

/// Boxes that cover what of a closed solid lies between the heights: its bounding box where it is closed and
/// fills at least `box_fill` of that (`full_fill` when it is large enough for a way through it), else its surface in
/// cells of cell_m, joined to rectangles; where those would be more than cells_max, of what lies within `area` only. No
/// boxes when nothing lies there. Throws InputError where that is too large still.
[[nodiscard]] std::vector<CollisionBox> solid_boxes(const bim::Solid& solid, const HeightRange& reach,
                                                    const Eigen::AlignedBox2d& area, const CollisionConfig& config);

}  // namespace plumbline::sim
