// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bim/geometry/plane.h"
#include "slam/io/estimate.h"
#include "slam/mapping/mirror_ghosts.h"
#include "slam/scan/voxel.h"

/// The faces of mapped walls, and which of them a point may lie on or a ray may hit.
namespace plumbline::slam {

/// A wall face: where it reaches, to its corners, and the stretch of it that was seen. It stands upright; the frame is
/// F.
struct WallFace {
  Plane plane;
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();
  double s0 = 0.0, s1 = 0.0, z0 = 0.0, z1 = 0.0;
  double seen_s0 = 0.0, seen_s1 = 0.0;

  /// The point of its trace at `s` along it.
  [[nodiscard]] Eigen::Vector2d at(double s) const { return s * along - plane.d * plane.n.head<2>(); }
};

/// One face for each wall; walls that are part of a better known one are left out.
[[nodiscard]] std::vector<WallFace> wall_faces(std::span<const PlaneNode> walls, const MirrorGhostConfig& config);

/// Faces by the squares of a grid that they go through, so that a point is compared with those beside it only.
class FacesNear {
 public:
  FacesNear(std::span<const WallFace> faces, double reach_m);

  /// Indices, rising, of all faces with p within reach_m of them and between their ends, and of some others.
  [[nodiscard]] std::span<const std::uint32_t> of(const Eigen::Vector3d& p_F) const;

 private:
  [[nodiscard]] VoxelKey square_of(const Eigen::Vector2d& p_F) const;

  double size_m_;
  VoxelIndex squares_;
  std::vector<std::vector<std::uint32_t>> faces_;  ///< index = slot
};

/// Faces that show one point their free side, by direction.
class FacesInView {
 public:
  /// A face and the distance of the point from it, m.
  struct Face {
    std::uint32_t index = 0;
    double from_m = 0.0;
  };

  FacesInView(std::span<const WallFace> faces, const Eigen::Vector3d& from_F);

  /// By rising index, all faces that a ray to p hits between their ends, and some others.
  [[nodiscard]] std::span<const Face> towards(const Eigen::Vector3d& p_F) const;

 private:
  static constexpr int sectors = 256;

  Eigen::Vector2d from_F_;
  std::array<std::vector<Face>, sectors> faces_;
};

}  // namespace plumbline::slam
