// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/symmetry/faces.h"
#include "bim/symmetry/symmetry.h"

namespace plumbline::bim {

/// One storey prepared for comparison.
class SymmetryScene {
 public:
  /// Everything that stands on a storey, with the edges of slab openings inside rooms.
  SymmetryScene(const Building& building, int storey, const SymmetryConfig& config);

  [[nodiscard]] int storey() const { return bodies_.storey; }
  [[nodiscard]] const std::vector<std::string>& left_out() const { return bodies_.left_out; }
  [[nodiscard]] const std::string& element_id(int element) const {
    return bodies_.elements[static_cast<std::size_t>(element)];
  }
  /// Larger extent of an element in plan, m: a surface without counterpart deviates by no more, however far the nearest
  /// one is.
  [[nodiscard]] double size_m(int element) const { return sizes_m_[static_cast<std::size_t>(element)]; }
  [[nodiscard]] const SurfaceIndex& surfaces() const { return surfaces_; }
  [[nodiscard]] double volume_m3() const { return volume_; }
  [[nodiscard]] const Eigen::Vector2d& centroid() const { return centroid_; }

  /// Volume that the image of `other` under g shares with this one, m^3.
  [[nodiscard]] double shared_volume(const SymmetryScene& other, const Isometry2& g) const;

 private:
  SymmetryBodies bodies_;
  std::vector<BodyPrism> disjoint_;
  BodyGrid grid_;
  SurfaceIndex surfaces_;
  std::vector<double> sizes_m_;  ///< by element
  double volume_ = 0.0;
  Eigen::Vector2d centroid_ = Eigen::Vector2d::Zero();
};

/// How well the image of `from` under g covers `to`.
[[nodiscard]] Similarity compare(const SymmetryScene& from, const SymmetryScene& to, const Isometry2& g,
                                 const SymmetryConfig& config);

/// Isometries that may take one storey to another, by matching directions, then places, of like surfaces; sorted by
/// angle. Proper ones, or with `mirrored` the others.
[[nodiscard]] std::vector<Isometry2> candidates(const SymmetryScene& from, const SymmetryScene& to, bool mirrored,
                                                const SymmetryConfig& config);

/// Classes of similar rooms of one storey. Appends to `classes`.
void find_similar_rooms(const Building& building, const std::vector<SymmetryScene>& scenes,
                        const SymmetryConfig& config, std::vector<RoomClass>& classes);

}  // namespace plumbline::bim
