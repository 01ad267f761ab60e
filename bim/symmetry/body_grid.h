// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

namespace plumbline::bim {

/// Boxes of the plane, looked up by position. Cells are as many as boxes at most.
class BodyGrid {
 public:
  /// Boxes keep their position in the list as their number.
  explicit BodyGrid(const std::vector<Eigen::AlignedBox2d>& boxes);

  /// Numbers of the boxes in the cells that `box` touches, ascending, each once, written over `found`.
  void near(const Eigen::AlignedBox2d& box, std::vector<int>& found) const;

 private:
  [[nodiscard]] Eigen::Vector2i cell(const Eigen::Vector2d& p) const;

  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  double cell_m_ = 1.0;
  Eigen::Vector2i size_ = Eigen::Vector2i::Zero();
  std::vector<std::vector<int>> cells_;
};

}  // namespace plumbline::bim
