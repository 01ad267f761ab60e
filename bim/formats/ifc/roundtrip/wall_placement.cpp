// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/roundtrip/wall_placement.h"

#include "bim/formats/ifc/step/shape.h"
#include "bim/geometry/polygon_boolean.h"

namespace plumbline::bim {

Eigen::Vector3d into_placement(const Wall& wall, const Eigen::Vector3d& p_W) {
  const Eigen::Vector2d r = p_W.head<2>() - wall.a;
  return {r.dot(wall.direction()), r.dot(wall.left()), p_W.z()};
}

Solid out_of_placement(const Wall& wall, Solid body_Q) {
  const Eigen::Vector2d e = wall.direction(), left = wall.left();
  for (Eigen::Vector3d& p : body_Q.vertices) {
    const Eigen::Vector2d turned = wall.a + p.x() * e + p.y() * left;
    p = Eigen::Vector3d(snap(turned.x(), solid_grid_m) + 0.0, snap(turned.y(), solid_grid_m) + 0.0, p.z());
  }
  return body_Q;
}

std::optional<Solid> into_placement(const Wall& wall, const Solid& body_W) {
  Solid body_Q = body_W;
  for (Eigen::Vector3d& p : body_Q.vertices) p = into_placement(wall, p);
  const Solid back = out_of_placement(wall, body_Q);
  return back.vertices == body_W.vertices ? std::optional(body_Q) : std::nullopt;
}

}  // namespace plumbline::bim
