// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/model/building.h"
#include "bim/symmetry/isometry.h"

namespace plumbline::bim {

/// A building without bodies from a model, taken through a proper isometry of the plane.
inline Building moved_building(const Building& building, const Isometry2& g) {
  Building image = building;
  for (Wall& wall : image.walls) {
    wall.a = g * wall.a;
    wall.b = g * wall.b;
  }
  for (Room& room : image.rooms) room.polygon = g * room.polygon;
  for (Column& column : image.columns) column.footprint = g * column.footprint;
  for (Slab& slab : image.slabs) slab.polygon.outer = g * slab.polygon.outer;
  for (Obstacle& obstacle : image.obstacles)
    for (Eigen::Vector3d& p : obstacle.body.vertices) p.head<2>() = g * Eigen::Vector2d(p.head<2>());
  return image;
}

}  // namespace plumbline::bim
