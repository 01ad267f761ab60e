// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "bim/formats/mesh/mesh_file.h"

namespace plumbline::bim {

struct MeshGroundConfig {
  double level = 0.98;         ///< z of a triangle's normal from which on it is floor (11 degrees)
  double layer_m = 0.1;        ///< heights this close are one floor
  double ground_share = 0.5;   ///< the lowest level with this share of the largest one's area is the ground
  double least_share = 0.05;   ///< neighbouring layers with this share of the largest are one level (assumed)
  double thin_m = 0.02;        ///< a level with less than flat_share of its largest layer in two layers of this
  double flat_share = 0.5;     ///< slopes (assumed: uneven floors lie within 4 cm)
  double rough_m = 0.5;        ///< small triangles are floor where their mean normal over so much is (assumed),
  double rough_level = 0.5;    ///< and none is steeper than this (60 degrees, assumed)
  double most_sunken_m = 0.3;  ///< what slopes to further below the ground is not walked
};

using TriangleCorners = std::array<Eigen::Vector3d, 3>;

/// Calls visit with the corners of every triangle.
template <class Visit>
void for_each_triangle(const std::vector<MeshPart>& parts, Visit&& visit) {
  for (const MeshPart& part : parts)
    for (const Eigen::Vector3i& t : part.solid.triangles) {
      const auto& v = part.solid.vertices;
      visit(TriangleCorners{v[static_cast<std::size_t>(t[0])], v[static_cast<std::size_t>(t[1])],
                            v[static_cast<std::size_t>(t[2])]});
    }
}

[[nodiscard]] double mean_height(const TriangleCorners& corners);

/// Which triangles are floor: those that face up, and the small ones of a rough surface that does.
class FloorFaces {
 public:
  FloorFaces(const std::vector<MeshPart>& parts, const MeshGroundConfig& config);
  /// Area on the plan, m^2; 0 where it is no floor.
  [[nodiscard]] double area(const TriangleCorners& corners) const;

 private:
  using Cell = std::array<std::int64_t, 3>;
  [[nodiscard]] std::optional<Cell> rough_cell(const TriangleCorners& corners, const Eigen::Vector3d& normal) const;

  MeshGroundConfig config_;
  std::map<Cell, Eigen::Vector3d> normals_;  ///< sums over small triangles
};

/// The floor that a storey stands on.
struct MeshGround {
  double z_m = 0.0;
  double low_m = 0.0, high_m = 0.0;  ///< between which its faces lie
  bool slopes = false;               ///< z_m is their mean
  bool more_below = false;           ///< as much floor lies below it
};

/// The lowest level that is about as large as the largest; a level may slope or be rough. Of a level floor with steps
/// the lowest large layer counts. Nothing where nothing faces up.
[[nodiscard]] std::optional<MeshGround> find_ground(const std::vector<MeshPart>& parts, const FloorFaces& floor,
                                                    const MeshGroundConfig& config);

}  // namespace plumbline::bim
