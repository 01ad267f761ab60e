// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <deque>
#include <span>
#include <vector>

#include "bim/config/visit.h"
#include "bim/geometry/pose.h"
#include "slam/registration/features.h"
#include "slam/registration/match.h"
#include "slam/registration/point_map.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

/// Edges beside surfels: along a bare corridor jambs and pillars are all that constrains the pose, and a surfel that
/// reaches round one of them is seen elsewhere from either side.
struct EdgeConfig {
  bool enabled = true;
  loam::FeatureConfig features{.max_range_m = 30.0};
  double leaf_m = 0.1;
  double reach_m = 0.4;
  double line_ratio = 20.0;
  double upright = 0.9;
  double sigma_m = 0.03;
  double huber_m = 0.06;

  template <class V>
  void visit(V& v) {
    v("enabled", enabled, Field{.doc = "match edges beside surfels"});
    v("features", features, Field{.advanced = true});
    v("leaf_m", leaf_m, Field{.doc = "voxel size of the map that holds one edge point each", .min = 0.02});
    v("reach_m", reach_m,
      Field{
          .doc = "largest distance to the farthest of the five neighbours that make a line", .min = 0.05, .max = 1.0});
    v("line_ratio", line_ratio,
      plain_field("least ratio of the largest to the second eigenvalue of neighbours on a line", {.min = 1.0}));
    v("upright", upright, share_field("least vertical part of a line's direction"));
    // Columns are 1 to 3 cm apart.
    v("sigma_m", sigma_m, Field{.doc = "standard deviation of an edge point across its line", .min = 1e-3});
    v("huber_m", huber_m, Field{.doc = "residual above which an edge counts linearly (Huber)", .min = 1e-3});
  }
};

/// Edge points of a scan [zhang2014, section V-A], the first one of each leaf, in R.
[[nodiscard]] std::vector<Eigen::Vector3d> edge_points(const DeskewedScan& scan, const EdgeConfig& config);

/// Edge points of the latest keyframes in M.
class EdgeMap {
 public:
  explicit EdgeMap(const EdgeConfig& config) : config_(config), points_(config.leaf_m, config.reach_m) {}

  /// Adds a keyframe's points; those of all but the latest `keep` keyframes go.
  void add(std::vector<Eigen::Vector3d> points_R, const Pose& X_MR, std::size_t keep);
  /// Ties each point that has a line through its five nearest in the map to that line.
  [[nodiscard]] std::vector<loam::Match> match(std::span<const Eigen::Vector3d> points_R, const Pose& X_MR) const;

 private:
  EdgeConfig config_;
  std::deque<std::vector<Eigen::Vector3d>> keyframes_;  ///< M
  loam::PointMap points_;
};

}  // namespace plumbline::slam
