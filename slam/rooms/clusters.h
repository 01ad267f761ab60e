// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "slam/rooms/free_graph.h"

namespace plumbline::slam {

/// Where free space is cut into rooms. watershed: where it is narrow relative to what it joins; fixed: [bavle2023, Alg.
/// 1].
enum class Cut { watershed, fixed };
[[nodiscard]] constexpr std::array<std::string_view, 2> names_of(Cut) { return {"watershed", "fixed"}; }

struct ClusterConfig {
  Cut cut = Cut::watershed;
  double threshold_m = 0.8;
  double spacing_m = 0.35;
  Removal removal = Removal::near;
  double saddle_ratio = 0.75;
  double min_clearance_m = 0.45;
  double min_area_m2 = 1.5;

  template <class V>
  void visit(V& v) {
    v("cut", cut, Field{.doc = "how free space is split: watershed at passages, or at a fixed clearance as published"});
    // t_lambda of [lsg2022].
    v("threshold_m", threshold_m, Field{.doc = "clearance of the fixed cut", .min = 0});
    // [lsg2022]
    v("spacing_m", spacing_m, Field{.doc = "spacing of the vertices of the fixed cut's graph", .min = 0});
    v("removal", removal, Field{.doc = "what the fixed cut removes: vertices near obstacles, or far from them"});
    v("saddle_ratio", saddle_ratio,
      share_field("clearance of a passage, as a share of the smaller space's, below which it separates them",
                  {.former = "neck_ratio"}));
    // Rooms from 0.9 m width on.
    v("min_clearance_m", min_clearance_m, Field{.doc = "least clearance at a cluster's widest point", .min = 0});
    // [lsg2022]
    v("min_area_m2", min_area_m2, Field{.doc = "least area of a cluster", .min = 0});
  }
};

/// A stretch of free space between narrow passages: a room, or a corridor.
struct Cluster {
  std::vector<std::size_t> cells;                      ///< ascending
  std::vector<std::size_t> boundary;                   ///< cells with a 4-neighbour outside the cluster, ascending
  Eigen::Vector2d center_M = Eigen::Vector2d::Zero();  ///< mean of the cells
  double clearance_m = 0.0;                            ///< at the widest point
  double area_m2 = 0.0;
};

/// Cells side by side in one row of the grid.
struct CellRun {
  std::size_t from = 0, to = 0;  ///< indices among the cluster's cells, [from, to)
  int i = 0, j = 0;              ///< column and row of the first
};

/// The cells of a cluster, ascending.
[[nodiscard]] std::vector<CellRun> runs_of(const GridFrame& frame, const std::vector<std::size_t>& cells);

/// Cells of a grid, ascending, as a cluster; its clearance is left at 0.
[[nodiscard]] Cluster cluster_of(const FreeGrid& grid, std::vector<std::size_t> cells);

/// Distance of every free cell to the nearest cell that is not free, m, exact on cell centres; 0 where not free.
[[nodiscard]] std::vector<float> distance_transform(const FreeGrid& grid);

/// Clusters of free space, in the order of their widest point (ties: lower cell). [bavle2023, Alg. 1], the fixed cut,
/// loses what is narrower than twice its threshold and does not part what a wider door joins. The watershed cuts a
/// passage where it is narrow relative to the spaces it joins: cells are added by falling clearance, each hilltop opens
/// a basin, and two basins that touch become one unless the pass between them lies below saddle_ratio times the lower
/// hilltop.
[[nodiscard]] std::vector<Cluster> clusters(const FreeGrid& grid, const ClusterConfig& config);

}  // namespace plumbline::slam
