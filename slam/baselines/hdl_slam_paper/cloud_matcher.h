// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "bim/config/visit.h"
#include "bim/geometry/pose.h"

namespace plumbline::slam::hdl {

/// What a registration found: the pose of the source S in the target T.
struct CloudMatch {
  Pose X_TS;
  /// False: nothing of S lies near T; of GICP also at the most iterations, of NDT not, as in the references.
  bool converged = false;
};

/// Registers one cloud with another, the target.
class CloudMatcher {
 public:
  virtual ~CloudMatcher() = default;
  virtual void set_target(const std::vector<Eigen::Vector3d>& points_T) = 0;
  [[nodiscard]] virtual CloudMatch match(const std::vector<Eigen::Vector3d>& points_S, const Pose& guess) const = 0;
};

/// Normal distributions of the target's cells [magnusson2009]; defaults of ndt_omp in hdl_graph_slam.
struct NdtConfig {
  double cell_m = 0.5;
  double outlier_share = 0.55;
  int least_points = 6;
  int max_iterations = 64;
  double step_m = 0.1;
  double epsilon = 0.01;

  template <class V>
  void visit(V& v) {
    v("cell_m", cell_m, Field{.doc = "size of a cell of the target", .min = 0.1, .max = 100.0, .basic = true});
    v("outlier_share", outlier_share,
      plain_field("share of points that are taken for outliers", {.min = 0.01, .max = 0.99}));
    v("least_points", least_points, Field{.doc = "least points of a cell", .min = 3});
    v("max_iterations", max_iterations, Field{.doc = "most iterations of a registration", .min = 1, .max = 10000});
    v("step_m", step_m, Field{.doc = "longest step of an iteration", .unit = "m, rad", .min = 1e-6, .max = 10.0});
    v("epsilon", epsilon,
      Field{.doc = "length of a step below which the iteration stops", .unit = "m, rad", .min = 1e-9, .max = 1.0});
  }
};

/// Plane-to-plane ICP [segal2009]; values of hdl_graph_slam's indoor launch file.
struct GicpConfig {
  int neighbours = 20;
  double max_distance_m = 2.0;
  double epsilon_m = 0.1;
  double rotation_epsilon = 2e-3;
  int max_iterations = 64;

  template <class V>
  void visit(V& v) {
    v("neighbours", neighbours, Field{.doc = "neighbours of a point whose spread is its covariance", .min = 4});
    v("max_distance_m", max_distance_m,
      Field{.doc = "largest distance of a point from its target point", .min = 0.01, .max = 100.0, .basic = true});
    v("epsilon_m", epsilon_m,
      Field{.doc = "largest coordinate of a step's translation at which the iteration stops", .min = 1e-9});
    v("rotation_epsilon", rotation_epsilon,
      plain_field("and largest change of an entry of its rotation matrix", {.min = 1e-9, .max = 1.0}));
    v("max_iterations", max_iterations, Field{.doc = "most iterations of a registration", .min = 1, .max = 10000});
  }
};

/// Score of a point beside a cell is d1 exp(-d2/2 q), q: squared Mahalanobis distance [magnusson2009, eq. 6.8].
struct NdtConstants {
  double d1 = 0.0;  ///< negative
  double d2 = 0.0;
};
[[nodiscard]] NdtConstants ndt_constants(double cell_m, double outlier_share);

[[nodiscard]] std::unique_ptr<CloudMatcher> make_ndt(const NdtConfig& config);
[[nodiscard]] std::unique_ptr<CloudMatcher> make_gicp(const GicpConfig& config);

}  // namespace plumbline::slam::hdl
