// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "slam/io/estimate.h"
#include "slam/rooms/clusters.h"

namespace plumbline::slam {

struct RoomConfig {
  double reach_m = 0.4;             ///< a cluster's border this close to a wall face lies on it
  double min_support_m = 0.6;       ///< border that must lie on a wall face
  double min_width_m = 1.0;         ///< between opposed walls [facts: slam 2.3]
  double opposed_deg = 8.0;         ///< largest angle between opposed walls
  double perpendicular_deg = 12.0;  ///< largest deviation of two pairs from a right angle
  double slack_m = 0.15;            ///< a cell this far behind a wall still counts as between the walls
  double inside_share = 0.88;       ///< of a cluster's cells that must lie between its walls
  double min_fill = 0.6;            ///< of a room's polygon that must be seen free
  double min_side_share = 0.25;     ///< of a four-wall room's side that must be seen as wall
  double min_two_wall_m = 1.5;      ///< border on each wall of a two-wall room
  bool polygons = true;             ///< rooms of more sides than four, and corridors that bend or run in a ring
  double rectangle_fill = 0.85;     ///< free share from which a four-wall room is not asked for a better outline
  double polygon_fill = 0.75;       ///< of a polygon that must be seen free
  double polygon_walled = 0.5;      ///< of its outline that must lie on walls that were seen
  double joined_share = 0.6;        ///< of the width between two walls over which clusters that share them are one
  double min_part_m2 = 2.0;         ///< of a straight part of a corridor in a ring
  double max_overlap = 0.3;         ///< of the smaller of two rooms; else the worse one is dropped
  bool entered_only = true;         ///< rooms that were merely looked into are not claimed

  template <class V>
  void visit(V& v) {
    v("reach_m", reach_m, Field{.doc = "from a cluster's border to its wall", .min = 0});
    v("min_support_m", min_support_m, Field{.doc = "border on a wall", .min = 0});
    v("min_width_m", min_width_m, Field{.doc = "of a room", .min = 0});
    v("opposed_deg", opposed_deg, Field{.doc = "largest angle between opposed walls", .min = 0, .max = 45});
    v("perpendicular_deg", perpendicular_deg, Field{.doc = "deviation from a right angle", .min = 0, .max = 45});
    v("slack_m", slack_m, Field{.doc = "cells this far behind a wall count as inside", .min = 0});
    v("inside_share", inside_share, Field{.doc = "cells between the walls", .min = 0, .max = 1});
    v("min_fill", min_fill, Field{.doc = "free share of a room's polygon", .min = 0, .max = 1});
    v("min_side_share", min_side_share, Field{.doc = "share of a side seen as wall", .min = 0, .max = 1});
    v("min_two_wall_m", min_two_wall_m, Field{.doc = "border on each wall of a two-wall room", .min = 0});
    v("polygons", polygons, Field{.doc = "rooms of more than four sides, parts of rings"});
    v("rectangle_fill", rectangle_fill, Field{.doc = "of a four-wall room that is one", .min = 0, .max = 1});
    v("polygon_fill", polygon_fill, Field{.doc = "free share of a polygon", .min = 0, .max = 1});
    v("polygon_walled", polygon_walled, Field{.doc = "of a polygon's outline", .min = 0, .max = 1});
    v("joined_share", joined_share,
      Field{.doc = "of the width between shared walls that joins clusters; above 1: never", .min = 0, .max = 2});
    v("min_part_m2", min_part_m2, Field{.doc = "of a ring's straight part", .min = 0});
    v("max_overlap", max_overlap, Field{.doc = "of two rooms", .min = 0, .max = 1});
    v("entered_only", entered_only, Field{.doc = "rooms that were merely looked into are not claimed"});
  }
};

/// A room as one look at the map shows it.
struct RoomCandidate {
  RoomKind kind = RoomKind::four_wall;
  std::vector<int> planes;  ///< PlaneNode ids: (x_a, x_b, y_a, y_b) or (a, b), opposed in pairs, lower id first; of a
                            ///< polygon its walls in order
  Eigen::Vector2d center_M = Eigen::Vector2d::Zero();   ///< [S-Graphs+ eq. 4, 5]; of a polygon the mean of `corners`
  Eigen::Vector2d cluster_M = Eigen::Vector2d::Zero();  ///< midpoint of the cluster's ends [S-Graphs+ eq. 6]
  Polygon2 polygon_M;                                   ///< counter-clockwise
  double fill = 0.0;                                    ///< free share of the polygon
  std::vector<std::array<int, 2>> corners = {};         ///< of a polygon: walls that meet, by their places in `planes`
};

/// Rooms that have been entered [S-Graphs+ section IV-C]: per cluster the opposed pair of wall faces that carries most
/// of its border (ties: lower ids) with the cluster between them, and the best perpendicular pair if there is one.
/// Beyond the papers: where no rectangle fits, the closed chain of walls and openings round the cluster; a cluster that
/// runs in a ring falls into its straight parts, the longest first.
/// visited_M: positions of the robot, for entered_only. In the clusters' order.
[[nodiscard]] std::vector<RoomCandidate> detect_rooms(const FreeGrid& grid, std::span<const Cluster> clusters,
                                                      std::span<const PlaneNode> walls_M,
                                                      std::span<const Eigen::Vector2d> visited_M,
                                                      const RoomConfig& config);

/// Index of the known room that each candidate is, or -1. Rooms are the same when their polygons share more than
/// `overlap` of the smaller; pairs by falling overlap (ties: lower indices), one-to-one.
[[nodiscard]] std::vector<int> associate_rooms(std::span<const Polygon2> known_M,
                                               std::span<const RoomCandidate> candidates, double overlap);

}  // namespace plumbline::slam
