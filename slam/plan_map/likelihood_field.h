// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bim/config/visit.h"
#include "slam/plan_map/plan_index.h"

namespace plumbline::slam {

struct LikelihoodFieldConfig {
  double cell_m = 0.05;
  double max_distance_m = 2.0;
  double slice_height_m = 0.7;  ///< above the floor: below sills, or a pane would be no wall
  int max_cells = 16'000'000;   ///< 64 MB

  template <class V>
  void visit(V& v) {
    v("cell_m", cell_m, Field{.doc = "of the grid; doubled until it fits max_cells", .min = 0.01, .max = 1});
    v("max_distance_m", max_distance_m, Field{.doc = "to the nearest wall; greater ones count as this", .min = 0.05});
    v("slice_height_m", slice_height_m, Field{.doc = "above the floor, at which the plan is cut"});
    v("max_cells", max_cells, Field{.doc = "of a storey", .min = 1000, .max = 1e9});
  }
};

/// A straight piece of wall in the horizontal plane; frame I.
struct SlicePiece {
  Eigen::Vector2d a, b;
};

/// What of the faces stands at a height above the floor, holes left out.
[[nodiscard]] std::vector<SlicePiece> cut_plan(const StoreyIndex& storey, double height_m);
/// Distance of a point from a piece, m.
[[nodiscard]] double distance_to(const SlicePiece& piece, const Eigen::Vector2d& p);

/// Distance from the middle of each cell of a grid to the nearest wall of a slice of the plan.
class LikelihoodField {
 public:
  LikelihoodField(const StoreyIndex& storey, const LikelihoodFieldConfig& config);

  /// Distance at the middle of the cell that holds p, m, at most the maximum; the maximum off the map.
  [[nodiscard]] double at(const Eigen::Vector2d& p) const {
    const double x = (p.x() - origin_.x()) / cell_, y = (p.y() - origin_.y()) / cell_;
    if (!(x >= 0.0 && y >= 0.0 && x < nx_ && y < ny_)) return max_distance_;
    return distance_[static_cast<std::size_t>(y) * static_cast<std::size_t>(nx_) + static_cast<std::size_t>(x)];
  }
  [[nodiscard]] double cell_m() const { return cell_; }
  [[nodiscard]] int nx() const { return nx_; }
  [[nodiscard]] int ny() const { return ny_; }
  /// Middle of a cell in I.
  [[nodiscard]] Eigen::Vector2d center(int x, int y) const {
    return origin_ + cell_ * Eigen::Vector2d(x + 0.5, y + 0.5);
  }
  /// Middles of the cells inside rooms that no wall passes through: where a robot may be.
  [[nodiscard]] const std::vector<Eigen::Vector2f>& free_cells() const { return free_cells_; }

 private:
  void add(const SlicePiece& piece);
  void find_free_cells(const StoreyIndex& storey);

  double cell_ = 0.05, max_distance_ = 2.0;
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  int nx_ = 0, ny_ = 0;
  std::vector<float> distance_;
  std::vector<Eigen::Vector2f> free_cells_;
};

}  // namespace plumbline::slam
