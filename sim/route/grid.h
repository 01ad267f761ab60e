// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <optional>

namespace plumbline::sim {

/// Square cells over the plane; cell (ix, iy) has index iy * nx + ix.
struct Grid {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< lower left corner of cell 0, W
  double cell = 0.05;                                ///< m
  int nx = 0;
  int ny = 0;

  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny); }
  [[nodiscard]] std::size_t index(int ix, int iy) const {
    return static_cast<std::size_t>(iy) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(ix);
  }
  [[nodiscard]] int ix(std::size_t i) const { return static_cast<int>(i % static_cast<std::size_t>(nx)); }
  [[nodiscard]] int iy(std::size_t i) const { return static_cast<int>(i / static_cast<std::size_t>(nx)); }
  [[nodiscard]] bool holds(int ix, int iy) const { return ix >= 0 && ix < nx && iy >= 0 && iy < ny; }
  [[nodiscard]] Eigen::Vector2d center(int ix, int iy) const {
    return origin + cell * Eigen::Vector2d(ix + 0.5, iy + 0.5);
  }
  [[nodiscard]] Eigen::Vector2d center(std::size_t i) const { return center(ix(i), iy(i)); }
  /// Column and row that hold a coordinate, which may lie off the grid.
  [[nodiscard]] int column(double x) const { return static_cast<int>(std::floor((x - origin.x()) / cell)); }
  [[nodiscard]] int row(double y) const { return static_cast<int>(std::floor((y - origin.y()) / cell)); }
  [[nodiscard]] std::optional<std::size_t> cell_at(const Eigen::Vector2d& p) const {
    if (!((p - origin).cwiseAbs().maxCoeff() < 1e6)) return std::nullopt;
    const int x = column(p.x());
    const int y = row(p.y());
    if (!holds(x, y)) return std::nullopt;
    return index(x, y);
  }
};

}  // namespace plumbline::sim
