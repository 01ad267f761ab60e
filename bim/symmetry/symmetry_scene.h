// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/symmetry/faces.h"
#include "bim/symmetry/symmetry.h"

namespace plumbline::bim {

/// One storey prepared for comparison.
class StoreyScene {
 public:
  /// Everything that stands on a storey, with the edges of slab openings inside rooms.
  StoreyScene(const Building& building, int storey, const SymmetryConfig& config);

  [[nodiscard]] int storey() const { return bodies_.storey; }
  [[nodiscard]] const std::string& element_id(int element) const {
    return bodies_.elements[static_cast<std::size_t>(element)];
  }
  [[nodiscard]] const SurfaceIndex& surfaces() const { return surfaces_; }
  [[nodiscard]] double volume_m3() const { return volume_; }
  [[nodiscard]] const Eigen::Vector2d& centroid() const { return centroid_; }

  /// Volume that the image of `other` under g shares with this one, m^3.
  [[nodiscard]] double shared_volume(const StoreyScene& other, const Isometry2& g) const;

 private:
  Bodies bodies_;
  std::vector<BodyPrism> disjoint_;
  PlaneGrid grid_;
  SurfaceIndex surfaces_;
  double volume_ = 0.0;
  Eigen::Vector2d centroid_ = Eigen::Vector2d::Zero();
};

/// How well the image of `from` under g covers `to`.
[[nodiscard]] Likeness compare(const StoreyScene& from, const StoreyScene& to, const Isometry2& g,
                               const SymmetryConfig& config);

/// Isometries that may take one storey to another, by matching directions, then places, of like surfaces; sorted by
/// angle. Proper ones, or with `mirrored` the others.
[[nodiscard]] std::vector<Isometry2> candidates(const StoreyScene& from, const StoreyScene& to, bool mirrored,
                                                const SymmetryConfig& config);

/// Rooms of one storey by how their inside looks. Appends to `classes`.
void find_like_rooms(const Building& building, const std::vector<StoreyScene>& scenes, const SymmetryConfig& config,
                     std::vector<RoomClass>& classes);

}  // namespace plumbline::bim
