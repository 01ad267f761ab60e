// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "bim/config/visit.h"
#include "bim/geometry/pose.h"
#include "slam/plan_map/plan_index.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

/// Resolution, neighbours and thinning are hdl_localization's [koide2019]. Its epsilon of 0.01 is not: steps here are
/// damped, so that a short one does not mean that the optimum is near.
struct NdtConfig {
  double resolution_m = 1.0;
  double sample_m = 0.1;
  double scan_voxel_m = 0.1;
  double min_range_m = 0.5;
  double max_range_m = 25.0;
  double outlier_ratio = 0.55;
  int max_iterations = 100;
  double epsilon = 1e-4;
  double inlier_sigmas = 3.0;
  int max_voxels = 4'000'000;

  template <class V>
  void visit(V& v) {
    v("resolution_m", resolution_m, Field{.doc = "voxel size of the map's Gaussians", .min = 0.1, .basic = true});
    v("sample_m", sample_m, Field{.doc = "spacing of the points drawn on the plan's faces", .min = 0.01});
    v("scan_voxel_m", scan_voxel_m,
      Field{.doc = "voxel size at which a scan is thinned to one point each", .min = 0.02, .basic = true});
    v("min_range_m", min_range_m, Field{.doc = "least range of a point that is used", .min = 0});
    v("max_range_m", max_range_m, Field{.doc = "largest range of a point that is used", .min = 1});
    // [magnusson2009, eq. 6.8]
    v("outlier_ratio", outlier_ratio,
      plain_field("share of outliers that shapes the score", {.min = 0.01, .max = 0.99}));
    v("max_iterations", max_iterations, Field{.doc = "most iterations of a registration", .min = 1});
    v("epsilon", epsilon, Field{.doc = "step below which the iteration stops", .unit = "m, rad", .min = 1e-6});
    v("inlier_sigmas", inlier_sigmas,
      plain_field("standard deviations from the nearest Gaussian up to which a point is an inlier", {.min = 0.1}));
    v("max_voxels", max_voxels,
      Field{.doc = "most voxels of a storey; the voxel size doubles until they fit", .min = 1000, .max = 1e8});
  }
};

/// Score of a scan at a pose with its derivatives by a right increment (rho, phi); lower is better.
struct NdtScore {
  double value = 0.0;
  Vector6d gradient = Vector6d::Zero();
  Matrix6d hessian = Matrix6d::Zero();  ///< of the Gaussians' quadratic forms alone: never indefinite
};

struct NdtMatch {
  Pose X_IR;
  double inliers = 0.0;  ///< share of the points, 0 to 1
};

/// Normal distributions of points drawn on a storey of the plan: its faces without their holes, floors and ceilings of
/// its rooms. Frame I.
class NdtMap {
 public:
  NdtMap(const StoreyIndex& storey, const NdtConfig& config);

  /// Over the voxel that a point falls into and its six neighbours.
  [[nodiscard]] NdtScore score(std::span<const Eigen::Vector3d> points_R, const Pose& X_IR) const;
  [[nodiscard]] double inliers(std::span<const Eigen::Vector3d> points_R, const Pose& X_IR) const;
  /// From a start by Gauss-Newton steps that lower the score. Without points the start itself.
  [[nodiscard]] NdtMatch align(std::span<const Eigen::Vector3d> points_R, const Pose& start) const;
  [[nodiscard]] std::size_t voxels() const { return gaussians_.size(); }

 private:
  struct Gaussian {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  };
  struct Sums {
    double n = 0.0;
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    Eigen::Matrix3d pp = Eigen::Matrix3d::Zero();
  };
  void lay_out(const StoreyIndex& storey);
  void add(const Eigen::Vector3d& p_I, std::vector<Sums>& sums) const;
  void add_faces(const StoreyIndex& storey, std::vector<Sums>& sums) const;
  void add_rooms(const StoreyIndex& storey, std::vector<Sums>& sums) const;
  [[nodiscard]] long voxel_at(const Eigen::Vector3d& p_I) const;
  template <class F>
  void for_neighbours(const Eigen::Vector3d& p_I, const F& f) const;

  NdtConfig config_;
  double d1_ = 0.0, d2_ = 0.0;  ///< of the score -d1 exp(-d2/2 e' B e), both positive
  double size_ = 1.0;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  Eigen::Vector3i count_ = Eigen::Vector3i::Zero();
  std::vector<int> index_;  ///< by voxel: into gaussians_, -1 empty
  std::vector<Gaussian> gaussians_;
};

/// Returns in the range gate, one mean point a voxel.
[[nodiscard]] std::vector<Eigen::Vector3d> ndt_points(const DeskewedScan& scan, const NdtConfig& config);

}  // namespace plumbline::slam
