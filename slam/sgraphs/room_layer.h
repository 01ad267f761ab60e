// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "slam/graph/graph.h"
#include "slam/rooms/detect.h"

namespace plumbline::slam {

struct RoomLayerConfig {
  FreeSpaceConfig free_space;
  ClusterConfig clusters;
  RoomConfig rooms;
  double redraw_m = 0.1;      ///< a keyframe that the graph moved this far has its free space drawn again
  double same_overlap = 0.3;  ///< of a known room and a candidate that are one
  double sigma_m = 0.05;      ///< of a room's centre between its walls

  template <class V>
  void visit(V& v) {
    v("free_space", free_space);
    v("clusters", clusters);
    v("rooms", rooms);
    v("redraw_m", redraw_m, Field{.doc = "correction of a keyframe that redraws free space", .min = 0});
    v("same_overlap", same_overlap, Field{.doc = "of a known room and a candidate that are one", .min = 0, .max = 1});
    v("sigma_m", sigma_m, Field{.doc = "of a room's centre between its walls", .min = 1e-4});
  }
};

/// The room layer of a graph [S-Graphs+ sections IV-C, V]. Rooms are derived anew from free space and walls at each
/// call and tied to the known ones by overlap, so that a two-wall room becomes a four-wall room when its ends are seen
/// and a mistaken room does not stay.
class RoomLayer {
 public:
  explicit RoomLayer(const RoomLayerConfig& config) : config_(config) {}

  /// Takes the newest keyframe's scan into the free space of its storey.
  void look(const Graph& graph, const DeskewedScan& scan);
  /// Rooms of a storey from its walls: vertices, and factors in place of the former ones.
  void update(Graph& graph, int storey, std::span<const PlaneNode> walls);
  /// Draws all free space again from the keyframes' present poses.
  void redraw(const Graph& graph);

  /// The rooms that the map shows, by id.
  [[nodiscard]] std::vector<RoomNode> nodes(const Graph& graph) const;

 private:
  struct Look {
    FreeRays rays;
    Pose X_MR;  ///< where it was drawn
    int storey = 0;
  };

  void redraw_if_moved(const Graph& graph);
  [[nodiscard]] std::vector<int> tie(Graph& graph, int storey, const std::vector<RoomCandidate>& candidates);
  FreeSpaceMap& map_of(int storey);

  RoomLayerConfig config_;
  std::vector<Look> looks_;                ///< index = keyframe
  std::map<int, FreeSpaceMap> maps_;       ///< by storey
  std::vector<RoomCandidate> candidates_;  ///< latest shape of each room; index = room id
};

}  // namespace plumbline::slam
