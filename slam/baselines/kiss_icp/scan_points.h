// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "bim/geometry/pose.h"
#include "slam/io/records.h"

namespace plumbline::slam::kiss {

/// A motion that goes on evenly: where L was a while before the scan's stamp, seen from where it is then.
class ConstantTwist {
 public:
  /// Stands still.
  ConstantTwist() = default;
  /// motion: of L over the period, seen from where it was.
  ConstantTwist(const Pose& motion, Nanoseconds period);

  /// Exp(xi offset / period) p, with xi = Log(motion).
  [[nodiscard]] Eigen::Vector3d to_stamp(const Eigen::Vector3d& p_L, Nanoseconds offset) const;

 private:
  double per_ns_ = 0.0;     ///< periods
  double angle_rad_ = 0.0;  ///< of one period
  Eigen::Vector3d axis_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rho_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d across_ = Eigen::Vector3d::Zero();   ///< axis x rho / angle
  Eigen::Vector3d across2_ = Eigen::Vector3d::Zero();  ///< axis x across
};

/// Time between a scan's first and last return; 0 where it has no times, that is, where all are the same.
[[nodiscard]] Nanoseconds sweep_duration(const Scan& scan);

/// Returns in L at the scan's stamp, in the order of their slots.
struct ScanPoints {
  std::vector<std::size_t> slots;
  std::vector<Eigen::Vector3d> points_L;
};

/// Moves returns to the stamp and takes those between the ranges, both excluded. What is no finite point is none.
[[nodiscard]] ScanPoints deskewed_points(const Scan& scan, const ConstantTwist& twist, double min_range_m,
                                         double max_range_m);

/// The first point of each voxel, as it is.
[[nodiscard]] std::vector<Eigen::Vector3d> first_of_voxels(std::span<const Eigen::Vector3d> points_L, double voxel_m);

}  // namespace plumbline::slam::kiss
