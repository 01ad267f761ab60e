// SPDX-License-Identifier: Apache-2.0
#include "bim/model/wall_face.h"

#include <cmath>

#include "bim/errors.h"

namespace plumbline::bim {

FaceLine face_line(const Wall& wall, int side) {
  const Eigen::Vector2d left = wall.left();
  if (side == 0) {
    const Eigen::Vector2d shift = (wall.offset_m + wall.thickness_m) * left;
    return {wall.a + shift, wall.b + shift};
  }
  return {wall.b + wall.offset_m * left, wall.a + wall.offset_m * left};
}

Polygon2 footprint(const Wall& wall) {
  const FaceLine left = face_line(wall, 0), right = face_line(wall, 1);
  return {right.p1, right.p0, left.p1, left.p0};
}

Plane face_plane(const Wall& wall, int side) {
  const Eigen::Vector2d left = wall.left();
  const Eigen::Vector2d on_right = wall.a + wall.offset_m * left;
  constexpr int body_behind = -1;
  if (wall.slope == 0.0) {
    const Plane right{Eigen::Vector3d(-left.x(), -left.y(), 0.0), left.dot(on_right)};
    return side == 0 ? opposite_face(right, wall.thickness_m, body_behind) : right;
  }
  const double cosine = 1.0 / std::sqrt(1.0 + wall.slope * wall.slope);
  const Eigen::Vector3d n = cosine * Eigen::Vector3d(-left.x(), -left.y(), wall.slope);
  const Plane right{n, -n.dot(Eigen::Vector3d(on_right.x(), on_right.y(), wall.z0_m))};
  return side == 0 ? opposite_face(right, wall.thickness_m * cosine, body_behind) : right;
}

Plane opposite_face(const Plane& plane, double thickness_m, int body_side) {
  if (body_side != 1 && body_side != -1) throw InternalError("a wall lies on one side of its plane: +1 or -1");
  return {-plane.n, -plane.d + body_side * thickness_m};
}

}  // namespace plumbline::bim
