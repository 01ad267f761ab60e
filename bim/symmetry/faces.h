// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "bim/symmetry/body_grid.h"
#include "bim/symmetry/isometry.h"
#include "bim/symmetry/symmetry_bodies.h"

namespace plumbline::bim {

/// Upright rectangle that a beam can hit: the body on the left of p to q, free space on the right.
struct SurfaceRect {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
  Eigen::Vector2d q = Eigen::Vector2d::Zero();
  double z0 = 0.0, z1 = 0.0;  ///< above the storey's floor
  int element = -1;           ///< into SymmetryBodies::elements

  [[nodiscard]] Eigen::Vector2d direction() const { return (q - p).normalized(); }
  [[nodiscard]] double length() const { return (q - p).norm(); }
  [[nodiscard]] double area() const { return length() * (z1 - z0); }
};

[[nodiscard]] SurfaceRect moved(const Isometry2& g, const SurfaceRect& rect);

/// What is left of a surface and no larger than this is none.
struct Slivers {
  double along_m = 0.0;
  double up_m =
      0.0;  ///< two bodies that end nearly level leave a strip as long as they are, far from any other surface
};

/// Outer surfaces of all bodies: what another body covers or touches is left out; of two that lie flush the earlier
/// body keeps its. Bodies closer than touch_m touch; slivers are dropped.
[[nodiscard]] std::vector<SurfaceRect> visible_surfaces(const std::vector<BodyPrism>& prisms, double touch_m,
                                                        const Slivers& slivers);

/// Distances to a set of surfaces.
class SurfaceIndex {
 public:
  explicit SurfaceIndex(std::vector<SurfaceRect> rects);

  struct Nearest {
    int rect = -1;
    double distance_m = 0.0;
  };
  /// The nearest surface whose normal does not oppose that of a surface along `direction`; of equal ones the first;
  /// absent when none lies within `reach_m`.
  [[nodiscard]] std::optional<Nearest> nearest(const Eigen::Vector3d& p, const Eigen::Vector2d& direction,
                                               double reach_m) const;
  /// Numbers of the rects whose plan stands near a box.
  void near(const Eigen::AlignedBox2d& box, std::vector<int>& found) const { grid_.near(box, found); }
  [[nodiscard]] const std::vector<SurfaceRect>& rects() const { return rects_; }

 private:
  std::vector<SurfaceRect> rects_;
  BodyGrid grid_;
};

}  // namespace plumbline::bim
