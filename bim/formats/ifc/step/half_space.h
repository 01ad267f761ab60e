// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "bim/formats/ifc/step/shape.h"
#include "bim/geometry/polygon.h"

namespace plumbline::bim {

/// IfcHalfSpaceSolid and IfcPolygonalBoundedHalfSpace [iso2018].
struct HalfSpace {
  Eigen::Affine3d X_PS = Eigen::Affine3d::Identity();  ///< frame of the plane, its normal along z
  bool agreement = true;                               ///< true: the side that the normal points away from
  struct Boundary {
    Eigen::Affine3d X_PB = Eigen::Affine3d::Identity();  ///< a prism along its z
    Polygon2 outline;                                    ///< in its xy plane
  };
  std::optional<Boundary> boundary;
};

/// The part of a half space that can meet what lies in a box, as a closed solid: a box on one side of the plane, or a
/// prism that ends at the plane. One whose plane runs along the prism comes as what the two have in common. Nullopt for
/// a boundary without area.
[[nodiscard]] std::optional<Shape> half_space_shape(const HalfSpace& half_space, const Eigen::AlignedBox3d& around);

}  // namespace plumbline::bim
