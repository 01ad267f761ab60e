// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "scenarios/report/map_drawing.h"

namespace plumbline::scenarios {

/// Where nearly all points of a map lie in the plane; a few far returns do not count.
[[nodiscard]] MapBox box_of_points(const std::vector<Eigen::Vector3f>& points_F);

/// A point map from above as SVG in cells of at least 5 cm, at most 400 a side: dark where something stands upright,
/// as a wall does, faint where there is anything else, as a floor. Over a plan only what is upright is drawn, in the
/// colour of the method. Points outside of the box are left out.
[[nodiscard]] std::string draw_map_points(const std::vector<Eigen::Vector3f>& points_F, const MapBox& box,
                                          bool over_plan);

}  // namespace plumbline::scenarios
