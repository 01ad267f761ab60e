// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/geometry/polygon.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// Faces of a body that look up and lie in one plane, seen from above.
struct UpwardFace {
  double z0_m = 0.0;  ///< height over the plan's origin
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  double top_m = 0.0;  ///< of its highest corner
  std::vector<Polygon2> triangles;
};

struct UpwardFaceConfig {
  double steepest = 0.40;  ///< tangent; a steeper face is left out
  double level = 2e-3;     ///< a flatter one is level
  double least_m2 = 0.01;  ///< planes of less area count as small
  /// Share of small planes in what is connected from which on it is an uneven surface; chamfers and slivers of level
  /// slabs have less (assumed).
  double uneven_share = 0.1;
  double patch_m = 0.5;  ///< small planes of an uneven surface are joined over cells of this size (assumed)
};

/// Upward faces of a body by plane: slope to a grid of 0.002, heights to 2 mm. Where an uneven surface is cut so finely
/// that hardly a plane has an area, neighbours stand in one plane as steep as they are on average.
[[nodiscard]] std::vector<UpwardFace> upward_faces(const Solid& body, const UpwardFaceConfig& config = {});

}  // namespace plumbline::bim
