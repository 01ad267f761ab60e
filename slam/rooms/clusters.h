// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "slam/rooms/free_graph.h"

namespace plumbline::slam {

/// Where free space is cut into rooms. necks: where it is narrow relative to what it joins; fixed: [S-Graphs+ Alg. 1].
enum class Cut { necks, fixed };

struct ClusterConfig {
  Cut cut = Cut::necks;
  double threshold_m = 0.8;         ///< t_lambda of the fixed cut [facts: slam 4.1]
  double spacing_m = 0.35;          ///< between vertices of the fixed cut's graph [facts: slam 4.1]
  Removal removal = Removal::near;  ///< of the fixed cut
  double neck_ratio = 0.75;  ///< a passage splits two spaces where its clearance is below this share of the smaller's
  double min_clearance_m = 0.45;  ///< of a cluster's widest place: rooms from 0.9 m width on
  double min_area_m2 = 1.5;       ///< [facts: slam 4.1]

  template <class V>
  void visit(V& v) {
    v("cut", cut, Field{.doc = "necks (relative) or fixed (as printed)"});
    v("threshold_m", threshold_m, Field{.doc = "distance to obstacles of the fixed cut", .min = 0});
    v("spacing_m", spacing_m, Field{.doc = "between vertices of the fixed cut's graph", .min = 0});
    v("removal", removal, Field{.doc = "what the fixed cut removes: near obstacles, or far from them"});
    v("neck_ratio", neck_ratio,
      Field{.doc = "clearance of a passage over that of a room it closes", .min = 0, .max = 1});
    v("min_clearance_m", min_clearance_m, Field{.doc = "at a cluster's widest place", .min = 0});
    v("min_area_m2", min_area_m2, Field{.doc = "of a cluster", .min = 0});
  }
};

/// A stretch of free space between necks: a room, or a corridor.
struct Cluster {
  std::vector<std::size_t> cells;                      ///< ascending
  std::vector<std::size_t> boundary;                   ///< cells with a 4-neighbour outside the cluster, ascending
  Eigen::Vector2d center_M = Eigen::Vector2d::Zero();  ///< mean of the cells
  double clearance_m = 0.0;                            ///< at the widest place
  double area_m2 = 0.0;
};

/// Cells side by side in one row of the grid.
struct CellRun {
  std::size_t from = 0, to = 0;  ///< places among the cluster's cells, [from, to)
  int i = 0, j = 0;              ///< column and row of the first
};

/// The cells of a cluster, ascending.
[[nodiscard]] std::vector<CellRun> runs_of(const GridFrame& frame, const std::vector<std::size_t>& cells);

/// Cells of a grid, ascending, as a cluster; its clearance is left at 0.
[[nodiscard]] Cluster cluster_of(const FreeGrid& grid, std::vector<std::size_t> cells);

/// Distance of every free cell to the nearest cell that is not free, m, exact on cell centres; 0 where not free.
[[nodiscard]] std::vector<float> clearance(const FreeGrid& grid);

/// Clusters of free space, in the order of their widest place (ties: lower cell). [S-Graphs+ Alg. 1], the fixed cut,
/// loses what is narrower than twice its threshold and does not part what a wider door joins. By necks a passage cuts
/// where it is narrow relative to the spaces it joins: cells are added by falling clearance, each hilltop opens a
/// basin, and two basins that meet become one unless the pass between them lies below neck_ratio times the lower
/// hilltop.
[[nodiscard]] std::vector<Cluster> clusters(const FreeGrid& grid, const ClusterConfig& config);

}  // namespace plumbline::slam

namespace plumbline {

template <>
struct EnumNames<slam::Cut> {
  static constexpr std::array<std::string_view, 2> names = {"necks", "fixed"};
};
template <>
struct EnumNames<slam::Removal> {
  static constexpr std::array<std::string_view, 2> names = {"near", "far"};
};

}  // namespace plumbline
