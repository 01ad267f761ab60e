// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "bim/model/building.h"

namespace plumbline::bim {

[[nodiscard]] Eigen::AlignedBox2d box_of(const Polygon2& outline);

/// Bounding boxes on the plan of a list of things, to pass over what is out of reach of another: a scan that costs
/// about a nanosecond a box, where looking at the things themselves costs a hundred.
class PlanBoxes {
 public:
  void add(const Polygon2& outline);
  /// Indices, ascending, of those that come within margin_m of the outline's box.
  [[nodiscard]] std::vector<int> near(const Polygon2& outline, double margin_m) const;

 private:
  std::vector<Eigen::AlignedBox2d> boxes_;
};

[[nodiscard]] PlanBoxes boxes_of(const std::vector<Room>& rooms);
/// Boxes of the walls' footprints, from wall `first` on; index 0 is that wall.
[[nodiscard]] PlanBoxes boxes_of(const std::vector<Wall>& walls, std::size_t first = 0);

}  // namespace plumbline::bim
