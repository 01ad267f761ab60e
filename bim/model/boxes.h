// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "bim/model/building.h"

namespace plumbline::bim {

[[nodiscard]] Eigen::AlignedBox2d box_of(const Polygon2& outline);
/// Of all vertices, also of those that no triangle has.
[[nodiscard]] Eigen::AlignedBox3d box_of(const Solid& solid);

/// Bounding boxes in plan view of a list of elements, for a broad-phase test: about a nanosecond a box, where an exact
/// test costs a hundred.
class BoxIndex {
 public:
  void add(const Polygon2& outline);
  /// Indices, ascending, of those that come within margin_m of the outline's box.
  [[nodiscard]] std::vector<int> near(const Polygon2& outline, double margin_m) const;

 private:
  std::vector<Eigen::AlignedBox2d> boxes_;
};

[[nodiscard]] BoxIndex boxes_of(const std::vector<Room>& rooms);
/// Boxes of the walls' footprints, from wall `first` on; index 0 is that wall.
[[nodiscard]] BoxIndex boxes_of(const std::vector<Wall>& walls, std::size_t first = 0);

}  // namespace plumbline::bim
