// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "slam/registration/surfels.h"

namespace plumbline::slam {

struct CellSurfels {
  double size_m = 0.3;
  int min_points = 8;                                    ///< in a surfel's voxel and the six around it
  double max_thickness_m = 0.1;                          ///< standard deviation across them
  std::optional<Eigen::Vector3d> sensor = std::nullopt;  ///< where the points were seen from, in their frame
};

/// One surfel per voxel: the mean of its points, and the normal of all points in it and the six voxels round it, so
/// that no neighbour is searched for. In the order of each voxel's first point. Points that are not finite are left
/// out. Times of the points, where they have any, give a surfel the mean of its own. Where a sensor sees all those
/// points in one line, as a ring that is alone there or bent round a corner, their plane is that of its laser, not of a
/// surface: the normal is then that of voxels twice as large, or there is none. The same where points are too few.
[[nodiscard]] std::vector<Surfel> cell_surfels(std::span<const Eigen::Vector3f> points, const CellSurfels& config,
                                               std::span<const float> times_s = {});
/// The same, and points without a surface: see Surfaces.
[[nodiscard]] Surfaces cell_surfaces(std::span<const Eigen::Vector3f> points, const CellSurfels& config,
                                     std::span<const float> times_s = {});

}  // namespace plumbline::slam
