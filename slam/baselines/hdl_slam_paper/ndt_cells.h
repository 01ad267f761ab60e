// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bim/geometry/pose.h"
#include "slam/baselines/hdl_slam_paper/cloud_matcher.h"
#include "slam/scan/voxel.h"

namespace plumbline::slam::hdl {

/// How well points fit to the cells at a pose; lower is better. The derivatives are by retract()'s step.
struct NdtScore {
  double value = 0.0;
  Vector6d gradient = Vector6d::Zero();
  Matrix6d hessian = Matrix6d::Zero();
};

/// Moves a pose by a translation in the axes of S and a rotation in S, m and rad.
[[nodiscard]] Pose retract(const Pose& X_TS, const Vector6d& step);

/// The target's cells, each the normal distribution of its points [magnusson2009].
class NdtCells {
 public:
  explicit NdtCells(const NdtConfig& config)
      : config_(config), constants_(ndt_constants(config.cell_m, config.outlier_share)) {}
  void set(const std::vector<Eigen::Vector3d>& points_T);
  /// Each point counts in its own cell and the six beside it.
  [[nodiscard]] NdtScore score(const std::vector<Eigen::Vector3d>& points_S, const Pose& X_TS) const;

 private:
  struct Cell {
    double n = 0.0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero(), information = Eigen::Matrix3d::Zero();
    bool valid = false;
  };
  /// Information of a cell's points; thin directions are widened to a hundredth of the widest.
  void complete(Cell& cell) const;

  NdtConfig config_;
  NdtConstants constants_;
  VoxelIndex index_;
  std::vector<Cell> cells_;
};

}  // namespace plumbline::slam::hdl
