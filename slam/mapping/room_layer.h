// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <span>
#include <string_view>

#include "slam/graph/graph.h"
#include "slam/mapping/same_walls.h"
#include "slam/rooms/keyframe_rooms.h"
#include "slam/rooms/room_detector.h"

namespace plumbline::slam {

/// What rooms are made of: free space and the whole map's walls, the planes of one keyframe alone, or free space and
/// the planes of one keyframe, as printed [bavle2023, section IV-C].
enum class RoomSource { free_space, keyframe, keyframe_clusters };
[[nodiscard]] constexpr std::array<std::string_view, 3> names_of(RoomSource) {
  return {"free_space", "keyframe", "keyframe_clusters"};
}

struct RoomLayerConfig {
  RoomSource source = RoomSource::free_space;
  FreeSpaceConfig free_space;
  ClusterConfig clusters;
  RoomConfig rooms;
  KeyframeRoomConfig keyframe_rooms;
  double refresh_m2 = 1.0;
  double rebuild_distance_m = 0.1;
  double same_overlap = 0.3;
  double same_center_m = 1.0;
  double sigma_m = 0.05;
  double two_wall_sigma_m = 0.05;

  template <class V>
  void visit(V& v) {
    v("source", source,
      Field{
          .doc =
              "where rooms come from: free space of a storey and its walls, the planes of one keyframe alone, or free "
              "space and the planes of one keyframe"});
    v("free_space", free_space);
    v("clusters", clusters);
    v("rooms", rooms);
    v("keyframe_rooms", keyframe_rooms, Field{.advanced = true});
    v("refresh_m2", refresh_m2,
      Field{.doc = "change of a storey's free space after which it is clustered again", .min = 0});
    v("rebuild_distance_m", rebuild_distance_m,
      Field{
          .doc = "correction of a keyframe after which its free space is drawn again", .min = 0, .former = "redraw_m"});
    v("same_overlap", same_overlap, share_field("least overlap of a known room and a candidate that are one"));
    // [lsg2022]
    v("same_center_m", same_center_m,
      Field{.doc = "largest distance between the centres of one room seen from two keyframes", .min = 0});
    v("sigma_m", sigma_m, Field{.doc = "standard deviation of a room's centre between its four walls", .min = 1e-4});
    v("two_wall_sigma_m", two_wall_sigma_m,
      Field{.doc = "standard deviation of a two-wall room's centre between its walls", .min = 1e-4});
  }
};

/// The room layer of a graph [bavle2023, sections IV-C, V]. Rooms are derived anew from free space and walls at each
/// call and tied to the known ones by overlap, so that a two-wall room becomes a four-wall room when its ends are seen
/// and a mistaken room does not stay.
class RoomLayer {
 public:
  explicit RoomLayer(const RoomLayerConfig& config) : config_(config) {}

  /// Adds the newest keyframe's scan and planes to the free space of its storey.
  void add_scan(const Graph& graph, const DeskewedScan& scan, std::span<const PlaneObservation> seen);
  /// Rooms of a storey from its walls: vertices, and factors in place of the former ones.
  void update(Graph& graph, int storey, std::span<const PlaneNode> walls);
  /// The rooms of the newest keyframe's own planes, but for RoomSource::free_space; known rooms stay.
  void add_from_keyframe(Graph& graph, std::span<const PlaneNode> seen_M);
  /// The room that the newest keyframe's own planes close round it, compared with the known ones of its storey: walls
  /// that are the same, see same_walls(). Rooms of four or two walls only.
  [[nodiscard]] std::vector<SameWall> find_revisited_walls(const Graph& graph, std::span<const PlaneNode> seen_M,
                                                           const WallDistance& distance) const;
  /// Names the planes that others have been merged into in those others' place. A factor whose walls have become one is
  /// dropped.
  void redirect_merged_planes(Graph& graph);
  /// Draws all free space again from the keyframes' present poses.
  void rebuild_free_space(const Graph& graph);

  /// The rooms that the map shows, by id; each polygon about the graph's centre.
  [[nodiscard]] std::vector<RoomNode> nodes(const Graph& graph) const;

 private:
  struct FreeSpaceScan {
    FreeRays rays;
    Pose X_MR;  ///< where it was drawn
    int storey = 0;
  };

  void rebuild_if_moved(const Graph& graph);
  [[nodiscard]] RoomFactor factor_of(const Graph& graph, int id, const RoomCandidate& room) const;
  [[nodiscard]] std::vector<RoomCandidate> rooms_round(const Graph& graph, std::span<const PlaneNode> seen_M);
  /// The known room that a candidate is by its centre, or -1.
  [[nodiscard]] int known_by_center(const Graph& graph, const RoomCandidate& room) const;
  [[nodiscard]] std::vector<int> associate(Graph& graph, int storey, const std::vector<RoomCandidate>& candidates);
  FreeSpaceMap& map_of(int storey);

  /// Free space as it was when it was last cut into clusters.
  struct Partition {
    FreeGrid seen;  ///< as drawn
    FreeGrid grid;  ///< without islands
    std::vector<Cluster> clusters;
  };
  const Partition& partition_of(int storey);

  RoomLayerConfig config_;
  std::vector<FreeSpaceScan> free_space_scans_;  ///< index = keyframe
  std::map<int, FreeSpaceMap> maps_;             ///< by storey
  std::map<int, Partition> partitions_;          ///< by storey
  std::vector<RoomCandidate> candidates_;        ///< latest shape of each room; index = room id
};

}  // namespace plumbline::slam
