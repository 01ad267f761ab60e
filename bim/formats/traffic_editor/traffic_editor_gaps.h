// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "bim/formats/traffic_editor/traffic_editor.h"

namespace plumbline::bim {

struct Segment {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();

  [[nodiscard]] double length() const { return (b - a).norm(); }
};

/// A stretch of a wall, m from its a.
struct WallSpan {
  int wall = -1;
  double s0 = 0.0, s1 = 0.0;
};

/// Where a door, or a part of it, lies along a wall it is in line with, from the wall's a.
[[nodiscard]] std::optional<std::pair<double, double>> overlap_in_line(const Segment& wall, const Segment& door,
                                                                       const TrafficEditorConfig& config);

/// True when another wall ends at p, or passes through it, at an angle.
[[nodiscard]] bool is_corner(const std::vector<Segment>& walls, std::size_t self, const Eigen::Vector2d& p,
                             const TrafficEditorConfig& config);

/// Gaps a wall's end leaves: to another wall's end that faces it, else to the wall straight ahead. Each from
/// the end with the lower wall index, ascending (of two ends equally near the lower index is taken).
[[nodiscard]] std::vector<Segment> find_doorways(const std::vector<Segment>& walls, const TrafficEditorConfig& config);

}  // namespace plumbline::bim
