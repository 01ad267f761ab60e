// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

#include "bim/config/visit.h"
#include "bim/geometry/pose.h"

namespace plumbline::slam {

/// Defaults: PCL's, but for the distance, which indoors is nearer than 5 m.
struct PclGicpConfig {
  double max_distance_m = 2.0;
  int neighbours = 20;
  int max_iterations = 200;
  int inner_iterations = 20;
  double translation_epsilon_m = 5e-4;
  double rotation_epsilon = 2e-3;

  template <class V>
  void visit(V& v) {
    v("max_distance_m", max_distance_m,
      Field{.doc = "largest distance of a point from its map point", .min = 0.01, .max = 100.0, .basic = true});
    v("neighbours", neighbours,
      Field{.doc = "neighbours of a point whose spread is its covariance", .min = 4, .max = 200});
    v("max_iterations", max_iterations,
      Field{.doc = "most iterations of a registration", .min = 1, .max = 10000, .basic = true});
    v("inner_iterations", inner_iterations, Field{.doc = "most steps of BFGS in each of them", .min = 1, .max = 1000});
    v("translation_epsilon_m", translation_epsilon_m,
      Field{.doc = "largest coordinate of an iteration's translation at which it stops", .min = 1e-9, .max = 1.0});
    v("rotation_epsilon", rotation_epsilon,
      plain_field("and largest change of an entry of its rotation matrix", {.min = 1e-9, .max = 1.0}));
  }
};

/// Defaults: PCL's, but for the epsilon. PCL compares it with the squared length of a step of at most step_m, so that
/// its own 0.1 ends after one step.
struct PclNdtConfig {
  double cell_m = 1.0;
  double step_m = 0.1;
  double outlier_share = 0.55;
  int max_iterations = 35;
  double epsilon_m2 = 1e-6;

  template <class V>
  void visit(V& v) {
    v("cell_m", cell_m, Field{.doc = "size of a cell of the map", .min = 0.5, .max = 100.0, .basic = true});
    v("step_m", step_m, Field{.doc = "longest step of the line search", .min = 1e-3, .max = 10.0});
    v("outlier_share", outlier_share,
      plain_field("share of points that are taken for outliers", {.min = 0.01, .max = 0.99}));
    v("max_iterations", max_iterations,
      Field{.doc = "most iterations of a registration", .min = 1, .max = 10000, .basic = true});
    v("epsilon_m2", epsilon_m2,
      Field{.doc = "squared translation of a step below which the iteration stops",
            .unit = "m²",
            .min = 1e-12,
            .max = 1.0});
  }
};

/// What PCL found.
struct PclMatch {
  Pose X_TS;
  bool converged = false;  ///< also at the most iterations
  double matched = 0.0;    ///< share of the points with a target point near them, where asked for
};

/// A registration of PCL. One thread, no chance; floats inside, so both frames' origins should be near the points.
class PclMatcher {
 public:
  virtual ~PclMatcher() = default;
  virtual void set_target(std::span<const Eigen::Vector3d> points_T) = 0;
  /// From X_TS, the guess. Nothing is found with fewer than least_points on either side, or than neighbours are asked
  /// for.
  [[nodiscard]] virtual PclMatch match(std::span<const Eigen::Vector3d> points_S, const Pose& X_TS) = 0;

  static constexpr std::size_t least_points = 50;
};

/// matched_m: how near a target point must be to match; 0: PclMatch::matched is not asked for.
[[nodiscard]] std::unique_ptr<PclMatcher> make_pcl_gicp(const PclGicpConfig& config, double matched_m);
[[nodiscard]] std::unique_ptr<PclMatcher> make_pcl_ndt(const PclNdtConfig& config, double matched_m);

}  // namespace plumbline::slam
