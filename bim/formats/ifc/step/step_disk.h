// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bim/formats/ifc/step/shape.h"

namespace plumbline::bim {

struct SweptDisk {
  double radius_m = 0.0;
  double inner_m = 0.0;  ///< of the hole of a pipe; 0 without one
  int corners = 0;       ///< of the polygon that the circle becomes
};

/// Whether a line of points begins straight up or down, or has a first piece without length: IFC++ then has no frame
/// to sweep a disk in.
[[nodiscard]] bool begins_upright(const std::vector<Eigen::Vector3d>& line);

/// The disk swept along the line, m, mitred where that bends. Empty for a line without length, one that turns back,
/// a disk without size, and one of more than a million corners.
[[nodiscard]] Facets swept_disk(const std::vector<Eigen::Vector3d>& line, const SweptDisk& disk);

}  // namespace plumbline::bim
