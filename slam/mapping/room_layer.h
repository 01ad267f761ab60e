// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <span>
#include <string_view>

#include "slam/graph/graph.h"
#include "slam/mapping/same_walls.h"
#include "slam/rooms/room_detector.h"

namespace plumbline::slam {

/// What rooms are made of: free space and the whole map's walls, or the planes of one keyframe alone.
enum class RoomSource { free_space, keyframe };

struct RoomLayerConfig {
  RoomSource source = RoomSource::free_space;
  FreeSpaceConfig free_space;
  ClusterConfig clusters;
  RoomConfig rooms;
  double refresh_m2 = 1.0;     ///< change of a storey's free space from which it is cut into clusters again
  double redraw_m = 0.1;       ///< a keyframe that the graph moved this far has its free space drawn again
  double same_overlap = 0.3;   ///< of a known room and a candidate that are one
  double same_center_m = 1.0;  ///< between the centres of one room seen from two keyframes [facts: slam 2.3]
  double sigma_m = 0.05;       ///< of a room's centre between its walls
  double two_wall_sigma_m = 0.05;

  template <class V>
  void visit(V& v) {
    v("source", source, Field{.doc = "free_space, or keyframe: the planes of one keyframe alone"});
    v("free_space", free_space);
    v("clusters", clusters);
    v("rooms", rooms);
    v("refresh_m2", refresh_m2, Field{.doc = "change of free space that renews its clusters", .min = 0});
    v("redraw_m", redraw_m, Field{.doc = "correction of a keyframe that redraws free space", .min = 0});
    v("same_overlap", same_overlap, Field{.doc = "of a known room and a candidate that are one", .min = 0, .max = 1});
    v("same_center_m", same_center_m, Field{.doc = "of one room seen from two keyframes", .min = 0});
    v("sigma_m", sigma_m, Field{.doc = "of a room's centre between its walls", .min = 1e-4});
    v("two_wall_sigma_m", two_wall_sigma_m, Field{.doc = "of a two-wall room's centre", .min = 1e-4});
  }
};

/// The room layer of a graph [S-Graphs+ sections IV-C, V]. Rooms are derived anew from free space and walls at each
/// call and tied to the known ones by overlap, so that a two-wall room becomes a four-wall room when its ends are seen
/// and a mistaken room does not stay.
class RoomLayer {
 public:
  explicit RoomLayer(const RoomLayerConfig& config) : config_(config) {}

  /// Takes the newest keyframe's scan and planes into the free space of its storey.
  void look(const Graph& graph, const DeskewedScan& scan, std::span<const PlaneObservation> seen);
  /// Rooms of a storey from its walls: vertices, and factors in place of the former ones.
  void update(Graph& graph, int storey, std::span<const PlaneNode> walls);
  /// The room that the newest keyframe's own planes close round it, for RoomSource::keyframe; known rooms stay.
  void add_from_keyframe(Graph& graph, std::span<const PlaneNode> seen_M);
  /// The room that the newest keyframe's own planes close round it, held against the known ones of its storey: walls
  /// that are one, see same_walls(). Rooms of four or two walls only.
  [[nodiscard]] std::vector<SameWall> seen_again(const Graph& graph, std::span<const PlaneNode> seen_M,
                                                 const WallMisfit& misfit) const;
  /// Names the planes that others have been merged into in those others' place, for RoomSource::keyframe; rooms from
  /// free space are derived anew at each update().
  void follow_merged(Graph& graph);
  /// Draws all free space again from the keyframes' present poses.
  void redraw(const Graph& graph);

  /// The rooms that the map shows, by id; each polygon about the graph's centre.
  [[nodiscard]] std::vector<RoomNode> nodes(const Graph& graph) const;

 private:
  struct Look {
    FreeRays rays;
    Pose X_MR;  ///< where it was drawn
    int storey = 0;
  };

  void redraw_if_moved(const Graph& graph);
  [[nodiscard]] RoomFactor factor_of(const Graph& graph, int id, const RoomCandidate& room) const;
  [[nodiscard]] std::vector<int> tie(Graph& graph, int storey, const std::vector<RoomCandidate>& candidates);
  FreeSpaceMap& map_of(int storey);

  /// Free space as it was when it was last cut into clusters.
  struct Partition {
    FreeGrid seen;  ///< as drawn
    FreeGrid grid;  ///< without islands
    std::vector<Cluster> clusters;
  };
  const Partition& partition_of(int storey);

  RoomLayerConfig config_;
  std::vector<Look> looks_;                ///< index = keyframe
  std::map<int, FreeSpaceMap> maps_;       ///< by storey
  std::map<int, Partition> partitions_;    ///< by storey
  std::vector<RoomCandidate> candidates_;  ///< latest shape of each room; index = room id
};

}  // namespace plumbline::slam

namespace plumbline {

template <>
struct EnumNames<slam::RoomSource> {
  static constexpr std::array<std::string_view, 2> names = {"free_space", "keyframe"};
};

}  // namespace plumbline
