// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "bim/config/visit.h"
#include "bim/geometry/pose.h"
#include "slam/scan/kd_tree.h"

namespace plumbline::slam::loam {

/// How a scan's features are matched with a map of keyframes; values of [shan2018], which [jiao2022] mostly shares.
struct KeyframeMapConfig {
  double radius_m = 50.0;
  double keyframe_voxel_m = 1.0;
  double edge_leaf_m = 0.2;
  double flat_leaf_m = 0.4;
  double max_distance2_m2 = 1.0;
  double line_ratio = 3.0;
  double plane_tolerance_m = 0.2;
  int rounds = 10;
  int iterations = 1;
  double huber_m = 0.0;
  double residual_weight = 0.9;
  int least_matches = 50;
  int least_edges = 10;
  int least_flats = 100;
  double least_eigenvalue = 100.0;

  template <class V>
  void visit(V& v) {
    v("radius_m", radius_m,
      Field{.doc = "distance up to which keyframes are matched with", .min = 1.0, .max = 1000.0, .basic = true});
    v("keyframe_voxel_m", keyframe_voxel_m, Field{.doc = "voxel size that holds one of them", .min = 0.01});
    v("edge_leaf_m", edge_leaf_m, Field{.doc = "voxel size of edges", .min = 0.02, .basic = true});
    v("flat_leaf_m", flat_leaf_m, Field{.doc = "voxel size of flat points", .min = 0.02, .basic = true});
    v("max_distance2_m2", max_distance2_m2,
      Field{.doc = "largest squared distance to the farthest of the five neighbours", .min = 1e-4});
    v("line_ratio", line_ratio,
      plain_field("least ratio of the largest to the second eigenvalue of neighbours on a line", {.min = 1.0}));
    v("plane_tolerance_m", plane_tolerance_m,
      Field{.doc = "largest distance of a neighbour from the fitted plane", .min = 1e-3});
    v("rounds", rounds, Field{.doc = "most rounds of matching", .min = 1, .max = 1000, .basic = true});
    v("iterations", iterations, Field{.doc = "solver iterations of a round", .min = 1, .max = 1000});
    v("huber_m", huber_m, Field{.doc = "residual above which a feature counts linearly (Huber); 0: never", .min = 0.0});
    v("residual_weight", residual_weight,
      plain_field("weight that a feature loses per metre of its residual; below a tenth it is left out", {.min = 0.0}));
    v("least_matches", least_matches, Field{.doc = "least features that match", .min = 6});
    v("least_edges", least_edges, Field{.doc = "least edges of the map, exclusive", .min = 0});
    v("least_flats", least_flats, Field{.doc = "least flat points of the map, exclusive", .min = 0});
    v("least_eigenvalue", least_eigenvalue,
      plain_field("eigenvalue of the normal matrix below which a direction is left as it is", {.min = 0.0}));
  }
};

/// Features of one scan in R.
struct MapFeatures {
  std::vector<Eigen::Vector3d> edges_R, flats_R;
};

/// One mean point a leaf.
[[nodiscard]] MapFeatures thinned(const MapFeatures& features, const KeyframeMapConfig& config);

struct MapAlignment {
  Pose X_MR;
  bool found = false;                  ///< false: too few features or matches, X_MR is the start
  int degenerate = 0;                  ///< directions that nothing held
  Matrix6d normal = Matrix6d::Zero();  ///< of the right increment, m^2
};

/// Features of keyframes, whose poses may change; scans are matched with those near them.
class KeyframeMap {
 public:
  explicit KeyframeMap(const KeyframeMapConfig& config) : config_(config) {}

  void add(const Pose& X_MR, MapFeatures features);
  void set_pose(std::size_t keyframe, const Pose& X_MR);
  [[nodiscard]] std::size_t size() const { return keyframes_.size(); }
  [[nodiscard]] const Pose& pose(std::size_t keyframe) const { return keyframes_[keyframe].X_MR; }
  [[nodiscard]] const MapFeatures& features(std::size_t keyframe) const { return keyframes_[keyframe].features; }

  /// Gauss-Newton on lines and planes through the five nearest map points. Degenerate directions, by the first round's
  /// normal matrix, are left as they are [zhang2016].
  [[nodiscard]] MapAlignment align(const MapFeatures& features, const Pose& start);

 private:
  struct Keyframe {
    Pose X_MR;
    MapFeatures features;
  };
  struct Submap {
    KdTree edges, flats;
  };

  /// The newest of each voxel within the radius, ascending.
  [[nodiscard]] std::vector<std::size_t> around(const Eigen::Vector3d& p_M) const;
  void update_submap(const Eigen::Vector3d& p_M);

  KeyframeMapConfig config_;
  std::vector<Keyframe> keyframes_;
  std::vector<std::size_t> selected_;
  std::optional<Submap> submap_;  ///< of selected_
};

}  // namespace plumbline::slam::loam
