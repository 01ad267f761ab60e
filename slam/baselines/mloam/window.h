// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>
#include <vector>

#include "bim/config/visit.h"
#include "bim/geometry/pose.h"
#include "slam/loam/keyframe_map.h"

namespace plumbline::slam::mloam {

struct WindowConfig {
  bool on = true;
  int scans = 4;
  int optimized = 2;
  double edge_leaf_m = 0.2;
  double flat_leaf_m = 0.4;
  double max_distance2_m2 = 1.0;
  double line_ratio = 3.0;
  double plane_ratio = 10.0;
  double plane_tolerance_m = 0.2;
  double huber_m = 1.0;
  int iterations = 5;
  double least_eigenvalue = 100.0;

  template <class V>
  void visit(V& v) {
    v("on", on, Field{.doc = "optimise the latest scans together", .basic = true});
    v("scans", scans, Field{.doc = "scans of the window", .min = 2, .max = 50, .basic = true});
    v("optimized", optimized,
      Field{.doc = "latest of them whose poses are optimised", .min = 1, .max = 49, .basic = true});
    v("edge_leaf_m", edge_leaf_m, Field{.doc = "voxel size of edges", .min = 0.02});
    v("flat_leaf_m", flat_leaf_m, Field{.doc = "voxel size of flat points", .min = 0.02});
    v("max_distance2_m2", max_distance2_m2,
      Field{.doc = "largest squared distance to the farthest of the five neighbours", .min = 1e-4});
    v("line_ratio", line_ratio,
      plain_field("least ratio of the largest to the second eigenvalue of neighbours on a line", {.min = 1.0}));
    v("plane_ratio", plane_ratio,
      plain_field("least ratio of the second to the smallest eigenvalue of neighbours on a plane", {.min = 1.0}));
    v("plane_tolerance_m", plane_tolerance_m,
      Field{.doc = "largest distance of a neighbour from the fitted plane", .min = 1e-3});
    v("huber_m", huber_m, Field{.doc = "residual above which a feature counts linearly (Huber)", .min = 1e-4});
    v("iterations", iterations, Field{.doc = "solver iterations; counted, never timed", .min = 1, .max = 1000});
    v("least_eigenvalue", least_eigenvalue,
      plain_field("eigenvalue of a pose's weighed normal matrix below which a direction is left as it is",
                  {.min = 0.0}));
  }
};

/// A quadratic 1/2 x' H x + g' x.
struct Quadratic {
  Eigen::MatrixXd H;
  Eigen::VectorXd g;
};

/// What it says of the variables behind the first n, which are minimised over. Directions of these that it does not
/// hold are left out.
[[nodiscard]] Quadratic marginalized(const Quadratic& quadratic, Eigen::Index n);

/// The latest scans. Those before the optimised ones make a map in the frame of the last of them, the pivot, which is
/// held; the others are matched with it. What leaves the window stays as a prior on the poses relative to the pivot
/// [jiao2022].
class Window {
 public:
  explicit Window(const WindowConfig& config) : config_(config) {}

  /// Adds a scan at a first guess of its pose and optimises; the scan's pose. Absent where it was not matched, as the
  /// first one is.
  [[nodiscard]] std::optional<Pose> add(const loam::MapFeatures& features, const Pose& X_MR);
  /// Forgets everything.
  void clear();

 private:
  struct Scan {
    loam::MapFeatures features;
    Pose X_MR;
  };

  [[nodiscard]] std::size_t pivot() const;
  [[nodiscard]] bool optimize();
  void slide();

  WindowConfig config_;
  std::deque<Scan> scans_;
  std::optional<Quadratic> prior_;  ///< on the pivot's and later poses at prior_poses_, but for the newest
  std::vector<Pose> prior_poses_;
  Quadratic last_;  ///< of the pivot's and later poses, as optimised
};

}  // namespace plumbline::slam::mloam
