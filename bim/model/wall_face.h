// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/model/building.h"

namespace plumbline::bim {

/// One side of a wall seen from above: free space lies on the left of p0 to p1.
struct FaceLine {
  Eigen::Vector2d p0 = Eigen::Vector2d::Zero();
  Eigen::Vector2d p1 = Eigen::Vector2d::Zero();
};

/// side 0: at offset + thickness, left of a to b, runs like a to b; side 1: at offset, runs the other way.
[[nodiscard]] FaceLine face_line(const Wall& wall, int side);

/// Plan outline of the uncut wall from reference line, offset and thickness, counter-clockwise.
[[nodiscard]] Polygon2 footprint(const Wall& wall);

/// Vertical plane of one side with its normal out of the wall [shaheer2023, eq. 1]: d = -n.p for a point p of the face.
/// The reference line lies on a face only by chance, hence the offset.
[[nodiscard]] Plane face_plane(const Wall& wall, int side);

/// The other side of a wall [shaheer2023, eq. 2]: n' = -n, d' = -d + s T with s = +1 when the wall lies on the side n
/// points to, -1 when on the other. The paper prints d + T, which mirrors the opposite face through the origin.
[[nodiscard]] Plane opposite_face(const Plane& plane, double thickness_m, int body_side);

}  // namespace plumbline::bim
