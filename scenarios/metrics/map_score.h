// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "bim/geometry/pose.h"
#include "bim/mesh/mesh.h"

namespace plumbline::scenarios::score {

/// Rules of the map metrics, docs/reference/metrics.md.
struct MapRules {
  double cap_m = 0.5;               ///< larger distances count as this
  double complete_within_m = 0.05;  ///< a surface point is mapped when a map point lies this near
};

/// A triangle of a mesh and how far a point is from it.
struct NearTriangle {
  int triangle = 0;
  double distance_m = 0.0;
};

/// Distance to the nearest triangle of a mesh, exact up to a cap: triangles in the cells of a uniform grid.
class SurfaceDistance {
 public:
  /// cap_m is also the size of a cell.
  SurfaceDistance(const bim::BuildingMesh& mesh, double cap_m);
  ~SurfaceDistance();
  SurfaceDistance(SurfaceDistance&&) noexcept;
  SurfaceDistance& operator=(SurfaceDistance&&) noexcept;

  /// min(cap, distance of p_W to the surface), m.
  [[nodiscard]] double operator()(const Eigen::Vector3d& p_W) const;
  /// Triangles within reach_m, at most the cap, of p_W; one may be listed more than once.
  [[nodiscard]] std::vector<NearTriangle> near(const Eigen::Vector3d& p_W, double reach_m) const;

 private:
  struct Grid;
  std::unique_ptr<const Grid> grid_;
};

/// Distance of a point to a triangle, m.
[[nodiscard]] double triangle_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                       const Eigen::Vector3d& c);

/// Share of `surface` points that have a point of `map` within the distance, in [0, 1]. surface must not be empty.
[[nodiscard]] double completeness(const std::vector<Eigen::Vector3d>& surface, const std::vector<Eigen::Vector3d>& map,
                                  double within_m);

struct MapScore {
  double rmse_m = 0.0;
  double capped_share = 0.0;  ///< of the map points, how many lie at the cap
  double completeness = 0.0;
};

/// Scores a non-empty map, placed in W by X_WF, against the as-built surface and the part of it that was truly hit.
[[nodiscard]] MapScore score_map(const std::vector<Eigen::Vector3f>& map_F, const Pose& X_WF,
                                 const SurfaceDistance& distance, const std::vector<Eigen::Vector3d>& surface_W,
                                 const MapRules& rules = {});

}  // namespace plumbline::scenarios::score
