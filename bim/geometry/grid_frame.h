// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace plumbline {

/// Square cells over a plane: cell (i, j) covers origin + cell * [i, i + 1) x [j, j + 1) and has index j * nx + i.
struct GridFrame {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< low corner of cell 0
  double cell = 0.1;                                 ///< m
  int nx = 0, ny = 0;

  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny); }
  [[nodiscard]] std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(i);
  }
  /// Column and row of a cell.
  [[nodiscard]] std::array<int, 2> column_and_row(std::size_t index) const {
    // Grids are far smaller than 2^32 cells, and a division of 32 bits is the faster one.
    const auto cell32 = static_cast<std::uint32_t>(index), width = static_cast<std::uint32_t>(nx);
    return {static_cast<int>(cell32 % width), static_cast<int>(cell32 / width)};
  }
  [[nodiscard]] bool holds(int i, int j) const { return i >= 0 && i < nx && j >= 0 && j < ny; }
  [[nodiscard]] Eigen::Vector2d center(int i, int j) const {
    return {origin.x() + cell * (i + 0.5), origin.y() + cell * (j + 0.5)};
  }
  [[nodiscard]] Eigen::Vector2d center(std::size_t index) const {
    const auto [i, j] = column_and_row(index);
    return center(i, j);
  }
  /// Column and row that hold a coordinate, which may lie off the grid.
  [[nodiscard]] int column(double x) const { return static_cast<int>(std::floor((x - origin.x()) / cell)); }
  [[nodiscard]] int row(double y) const { return static_cast<int>(std::floor((y - origin.y()) / cell)); }
  /// Index of the cell that holds p; none outside.
  [[nodiscard]] std::optional<std::size_t> find(const Eigen::Vector2d& p) const {
    const double x = (p.x() - origin.x()) / cell, y = (p.y() - origin.y()) / cell;
    if (!(x >= 0.0 && y >= 0.0 && x < nx && y < ny)) return std::nullopt;
    return index(static_cast<int>(x), static_cast<int>(y));
  }
};

}  // namespace plumbline
