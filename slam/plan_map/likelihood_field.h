// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "bim/config/visit.h"
#include "bim/geometry/grid_frame.h"
#include "slam/plan_map/plan_index.h"

namespace plumbline::slam {

struct LikelihoodFieldConfig {
  double cell_m = 0.05;
  double max_distance_m = 2.0;
  double slice_height_m = 0.7;
  int max_cells = 16'000'000;

  template <class V>
  void visit(V& v) {
    v("cell_m", cell_m,
      Field{.doc = "cell size of the grid; it doubles until max_cells suffices", .min = 0.01, .max = 1});
    v("max_distance_m", max_distance_m,
      Field{.doc = "largest distance to the nearest wall; greater ones count as this", .min = 0.05});
    // Below sills, or a pane would be no wall.
    v("slice_height_m", slice_height_m,
      Field{.doc = "height above the floor at which the plan is cut", .min = -10, .max = 100});
    v("max_cells", max_cells, Field{.doc = "most cells of a storey", .min = 1000, .max = 1e9});
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
    const std::optional<std::size_t> cell = frame_.find(p);
    return cell ? distance_[*cell] : max_distance_;
  }
  /// The grid in I.
  [[nodiscard]] const GridFrame& frame() const { return frame_; }
  /// Middles of the cells inside rooms that no wall passes through: where a robot may be.
  [[nodiscard]] const std::vector<Eigen::Vector2f>& free_cells() const { return free_cells_; }

 private:
  void add(const SlicePiece& piece);
  void find_free_cells(const StoreyIndex& storey);

  GridFrame frame_;
  double max_distance_ = 2.0;
  std::vector<float> distance_;
  std::vector<Eigen::Vector2f> free_cells_;
};

}  // namespace plumbline::slam
