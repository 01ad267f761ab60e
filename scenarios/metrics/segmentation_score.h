// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "scenarios/metrics/map_score.h"
#include "scenarios/metrics/trajectory.h"

namespace plumbline::scenarios::score {

/// Rules of the metrics of plane segmentation, docs/reference/metrics.md.
struct SegmentationRules {
  double within_m = 0.10;  ///< of the surface that a return lies on
  double apart_m = 0.03;   ///< another surface that is not farther by this makes the return ambiguous, as in a corner
  double same_deg = 1.0;   ///< triangles this near in direction
  double same_m = 0.01;    ///< and in place are one surface, whatever elements they belong to
  double precise = 0.8;    ///< share of a plane's returns that one surface has [hoover1996]
  int least_returns = 30;  ///< of a surface or plane that counts, in one scan
};

struct SegmentationScore {
  int planes = 0;                            ///< found, over the scans that were kept
  int surfaces = 0;                          ///< to be found
  std::optional<double> precision;           ///< planes that lie on one surface, per plane
  std::optional<double> recall;              ///< returns on these surfaces whose plane is this surface's, per return
  std::optional<double> planes_per_surface;  ///< of the surfaces that have any; 1 is right
};

/// Which surface of the building a return is of. A surface is all that lies in one plane and faces one way.
class SurfaceLabels {
 public:
  /// The mesh must outlive it; distance is of this mesh.
  SurfaceLabels(const bim::BuildingMesh& mesh, const SurfaceDistance& distance, const SegmentationRules& rules);

  /// Surface that faces from_W at p_W; -1: none near, or ambiguous.
  [[nodiscard]] int of(const Eigen::Vector3d& p_W, const Eigen::Vector3d& from_W);

 private:
  [[nodiscard]] Plane plane_of(int triangle) const;
  [[nodiscard]] int surface_of(int triangle);

  const bim::BuildingMesh& mesh_;
  const SurfaceDistance& distance_;
  SegmentationRules rules_;
  std::vector<int> surface_of_triangle_;  ///< -1: not asked yet
  std::vector<Plane> surfaces_;
};

/// Scores how returns of single scans were put into planes, against the surfaces that they lie on at the true pose.
[[nodiscard]] SegmentationScore score_segmentation(const std::vector<slam::SegmentedScan>& scans, const Truth& truth,
                                                   const bim::BuildingMesh& mesh, const SurfaceDistance& distance,
                                                   const SegmentationRules& rules = {});

}  // namespace plumbline::scenarios::score
