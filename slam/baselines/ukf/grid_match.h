// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "bim/config/visit.h"
#include "slam/plan_map/likelihood_field.h"
#include "slam/plan_map/pose2.h"

namespace plumbline::slam {

struct GridMatchConfig {
  double cell_m = 0.25;
  double sigma_m = 0.25;
  int levels = 6;
  double max_range_m = 15.0;
  int max_cells = 1'000'000;
  int max_nodes = 20'000'000;

  template <class V>
  void visit(V& v) {
    v("cell_m", cell_m,
      Field{.doc = "cell size of the grid; it also sets the step of yaw", .min = 0.02, .max = 5, .basic = true});
    v("sigma_m", sigma_m, Field{.doc = "standard deviation of a point's distance from a wall", .min = 0.01});
    v("levels", levels, Field{.doc = "levels of the grid pyramid", .min = 1, .max = 10});
    v("max_range_m", max_range_m, Field{.doc = "largest range of a point that is used", .min = 1});
    v("max_cells", max_cells,
      Field{.doc = "most cells of a storey; the cell size doubles until they fit", .min = 1000, .max = 1e8});
    v("max_nodes", max_nodes, Field{.doc = "nodes expanded before the search gives up", .min = 1000, .max = 2e9});
  }
};

/// A pose of the grid and what it scored.
struct GridMatch {
  int score = -1;  ///< sum over the points of 0 (far from walls) to 255 (on one)
  int turn = 0;    ///< index of the yaw
  int x = 0, y = 0;
  bool complete = true;  ///< false: the search gave up, a better one may exist

  /// Higher score first; ties: lowest yaw, then y, then x.
  [[nodiscard]] bool before(const GridMatch& other) const;
};

/// Best placement of a planar scan on a slice of a plan, by branch and bound. The bound of a block of cells is a
/// sliding maximum over just these cells [hess2016, section V-B], so it is never too low and the answer is that of an
/// exhaustive search of the grid.
class GridMatcher {
 public:
  GridMatcher(const StoreyIndex& storey, double slice_height_m, const GridMatchConfig& config);

  /// Of points in a level frame, at yaws (rad). Points beyond the largest range are left out.
  [[nodiscard]] GridMatch best(std::span<const Eigen::Vector2d> points, std::span<const double> yaws) const;
  [[nodiscard]] int score(std::span<const Eigen::Vector2d> points, double yaw, int x, int y) const;
  [[nodiscard]] Pose2 pose(const GridMatch& match, std::span<const double> yaws) const;
  /// Steps at which a point at the largest range moves by one cell, over half a turn to either side of a yaw.
  [[nodiscard]] std::vector<double> yaws(double middle, double half_width) const;
  [[nodiscard]] int nx() const { return frame_.nx; }
  [[nodiscard]] int ny() const { return frame_.ny; }

 private:
  /// Values where each covers 2^level x 2^level cells from (x, y) on; x and y from -(2^level - 1).
  struct Level {
    int pad = 0, width = 0, height = 0;
    std::vector<std::uint8_t> values;
    [[nodiscard]] int at(int x, int y) const {
      const int column = x + pad, row = y + pad;
      if (column < 0 || row < 0 || column >= width || row >= height) return 0;
      return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)];
    }
  };
  using Cells = std::vector<Eigen::Vector2i>;
  struct Node {
    GridMatch bound;
    int level = 0;
  };
  [[nodiscard]] Cells cells_of(std::span<const Eigen::Vector2d> points, double yaw) const;
  [[nodiscard]] GridMatch bound_of(const Cells& cells, int turn, int level, int x, int y) const;
  void descend(const Node& node, const std::vector<Cells>& cells, GridMatch& best, int& nodes) const;

  GridMatchConfig config_;
  GridFrame frame_;
  std::vector<Level> levels_;
};

}  // namespace plumbline::slam
