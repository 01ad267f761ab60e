// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "slam/io/estimate.h"
#include "slam/rooms/clusters.h"

namespace plumbline::slam {

struct RoomConfig {
  double reach_m = 0.4;
  double min_support_m = 0.6;
  double min_width_m = 1.0;
  double opposed_deg = 8.0;
  double perpendicular_deg = 12.0;
  double slack_m = 0.15;
  double inside_share = 0.88;
  double min_fill = 0.6;
  double min_side_share = 0.25;
  double min_two_wall_m = 1.5;
  bool polygons = true;
  double rectangle_fill = 0.85;
  double polygon_fill = 0.75;
  double polygon_wall_share = 0.5;
  double edge_share = 0.75;
  double joined_share = 0.6;
  double passed_share = 0.4;
  double wide_m = 1.6;
  double min_part_m2 = 2.0;
  double cut_share = 0.4;
  double max_overlap = 0.3;
  bool entered_only = true;

  template <class V>
  void visit(V& v) {
    v("reach_m", reach_m,
      Field{.doc = "largest distance of a cluster's border from the wall face it lies on", .min = 0});
    v("min_support_m", min_support_m, Field{.doc = "least length of border that lies on a wall face", .min = 0});
    // [lsg2022]
    v("min_width_m", min_width_m, Field{.doc = "least width between opposed walls", .min = 0});
    v("opposed_deg", opposed_deg, Field{.doc = "largest angle between opposed walls", .min = 0, .max = 45});
    v("perpendicular_deg", perpendicular_deg,
      Field{.doc = "largest deviation of two pairs of walls from a right angle", .min = 0, .max = 45});
    v("slack_m", slack_m,
      Field{.doc = "distance behind a wall up to which cells count as between the walls", .min = 0});
    v("inside_share", inside_share, share_field("least share of a cluster's cells between its walls"));
    v("min_fill", min_fill, share_field("least share of a room's polygon that is seen free"));
    v("min_side_share", min_side_share,
      share_field("least share of each side of a four-wall room that is seen as wall"));
    v("min_two_wall_m", min_two_wall_m,
      Field{.doc = "least length of border on each wall of a two-wall room", .min = 0});
    v("polygons", polygons,
      Field{.doc = "also rooms of more than four sides, and corridors that bend or run in a ring", .basic = true});
    v("rectangle_fill", rectangle_fill, share_field("free share from which on a four-wall room keeps its rectangle"));
    v("polygon_fill", polygon_fill, share_field("least share of a polygon that is seen free"));
    v("polygon_wall_share", polygon_wall_share,
      share_field("least share of a polygon's outline on observed walls", {.former = "polygon_walled"}));
    v("edge_share", edge_share,
      share_field(
          "least share of the outline of a room that was partly seen on walls or straight edges of free space"));
    v("joined_share", joined_share,
      plain_field("share of the width between two shared walls over which clusters join; above 1: never",
                  {.min = 0, .max = 2}));
    v("passed_share", passed_share,
      plain_field("the same where what stands between them is thicker than a wall; above 1: never",
                  {.min = 0, .max = 2}));
    // Wider than doors.
    v("wide_m", wide_m,
      Field{.doc = "length of their contact above which clusters that are no rooms may be parts of one", .min = 0});
    v("min_part_m2", min_part_m2,
      Field{.doc = "least area of a straight part of a corridor in a ring, and of a part of an open plan", .min = 0});
    v("cut_share", cut_share,
      plain_field("share of the border between two parts of an open plan from which on walls on it part them; above 1: "
                  "never",
                  {.min = 0, .max = 2}));
    v("max_overlap", max_overlap,
      share_field("largest overlap of two rooms, of the smaller; above it the worse one is dropped"));
    v("entered_only", entered_only, Field{.doc = "report only rooms that the robot has entered"});
  }
};

/// A room as one detection finds it.
struct RoomCandidate {
  RoomKind kind = RoomKind::four_wall;
  std::vector<int> planes;  ///< PlaneNode ids: (x_a, x_b, y_a, y_b) or (a, b), opposed in pairs, lower id first; of a
                            ///< polygon its walls in order
  Eigen::Vector2d center_M = Eigen::Vector2d::Zero();   ///< [bavle2023, eq. 4, 5]; of a polygon the mean of `corners`
  Eigen::Vector2d cluster_M = Eigen::Vector2d::Zero();  ///< midpoint of the cluster's ends [bavle2023, eq. 6]
  Polygon2 polygon_M;                                   ///< counter-clockwise
  double fill = 0.0;                                    ///< free share of the polygon
  std::vector<std::array<int, 2>> corners = {};         ///< of a polygon: walls that meet, by their indices in `planes`
};

/// Rooms that have been entered [bavle2023, section IV-C]: per cluster the opposed pair of wall faces that carries most
/// of its border (ties: lower ids) with the cluster between them, and the best perpendicular pair if there is one.
/// Beyond the papers (`polygons`): a cluster is cut first where walls stop short of each other, see cut_along_walls();
/// where no rectangle fits, the closed chain of walls and openings round it, or of walls and straight edges of free
/// space; a cluster that runs in a ring falls into its straight parts, the longest first; clusters that touch widely
/// and of which none is a room are tried as one. visited_M: positions of the robot, for entered_only and the cuts. In
/// the clusters' order.
[[nodiscard]] std::vector<RoomCandidate> detect_rooms(const FreeGrid& grid, std::span<const Cluster> clusters,
                                                      std::span<const PlaneNode> walls_M,
                                                      std::span<const Eigen::Vector2d> visited_M,
                                                      const RoomConfig& config);

/// Index of the known room that each candidate is, or -1. Rooms are the same when their polygons share more than
/// `overlap` of the smaller; pairs by falling overlap (ties: lower indices), one-to-one.
[[nodiscard]] std::vector<int> associate_rooms(std::span<const Polygon2> known_M,
                                               std::span<const RoomCandidate> candidates, double overlap);

}  // namespace plumbline::slam
