// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "bim/config/visit.h"
#include "slam/registration/features.h"
#include "slam/registration/point_map.h"
#include "slam/registration/registration.h"

namespace plumbline::slam::loam {

/// [zhang2014, section VI]. Leaves are half of A-LOAM's and F-LOAM's VLP-16 settings, which indoors hold two surfaces
/// at once (drift of a 7 m walk: 0.23 m with theirs, 0.03 m with these and plane_ratio).
struct MapConfig {
  double edge_leaf_m = 0.1;
  double plane_leaf_m = 0.2;
  double max_distance2_m2 = 1.0;
  double line_ratio = 3.0;
  double plane_ratio = 10.0;
  double plane_tolerance_m = 0.2;
  double huber_m = 0.1;
  int iterations = 4;

  template <class V>
  void visit(V& v) {
    v("edge_leaf_m", edge_leaf_m,
      Field{.doc = "voxel size of the map that holds one edge point each", .min = 0.02, .basic = true});
    v("plane_leaf_m", plane_leaf_m,
      Field{.doc = "voxel size of the map that holds one planar point each", .min = 0.02, .basic = true});
    v("max_distance2_m2", max_distance2_m2,
      Field{.doc = "largest squared distance to the farthest of the five neighbours", .min = 1e-4, .max = 1.0});
    v("line_ratio", line_ratio,
      plain_field("least ratio of the largest to the second eigenvalue of neighbours on a line", {.min = 1.0}));
    // Five points of one ring span no plane.
    v("plane_ratio", plane_ratio,
      plain_field("least ratio of the second to the smallest eigenvalue of neighbours on a plane", {.min = 1.0}));
    v("plane_tolerance_m", plane_tolerance_m,
      Field{.doc = "largest distance of a neighbour from the fitted plane", .min = 1e-3});
    v("huber_m", huber_m, Field{.doc = "residual above which a feature counts linearly (Huber)", .min = 1e-4});
    v("iterations", iterations, Field{.doc = "solver iterations of one round of matching", .min = 1});
  }
};

/// Feature points of one scan, the first one of each of the map's leaves, in R.
struct ThinFeatures {
  std::vector<Eigen::Vector3d> edges_R;
  std::vector<Eigen::Vector3d> planes_R;
};
[[nodiscard]] ThinFeatures thin(const Features& features, const MapConfig& config);

/// Map of edge and planar points in M, against which a scan is matched.
class FeatureMap {
 public:
  explicit FeatureMap(const MapConfig& config);

  void add(const ThinFeatures& features, const Pose& X_MR);
  [[nodiscard]] bool empty() const { return edges_.empty() && planes_.empty(); }
  /// Moves `start` so that edges lie on lines and planar points on planes through their five nearest map points:
  /// `rounds` times matching, then Gauss-Newton under a Huber kernel. Information: of the right increment, in units of
  /// the residuals' own scatter.
  [[nodiscard]] Registration align(const ThinFeatures& features, const Pose& start, int rounds) const;

 private:
  MapConfig config_;
  PointMap edges_;
  PointMap planes_;
};

}  // namespace plumbline::slam::loam
