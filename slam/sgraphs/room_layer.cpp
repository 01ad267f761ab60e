// SPDX-License-Identifier: Apache-2.0
#include "slam/sgraphs/room_layer.h"

#include <algorithm>

namespace plumbline::slam {

void RoomLayer::look(const Graph& graph, const DeskewedScan& scan) {
  const KeyframeVertex& keyframe = graph.keyframes.back();
  const Eigen::Vector3d up_R = keyframe.X_MR.q.conjugate() * Eigen::Vector3d::UnitZ();
  looks_.push_back({free_rays(scan, up_R, config_.free_space), keyframe.X_MR, keyframe.storey});
  map_of(keyframe.storey).carve(looks_.back().rays, keyframe.X_MR);
}

void RoomLayer::update(Graph& graph, int storey, std::span<const PlaneNode> walls) {
  redraw_if_moved(graph);
  const FreeGrid grid = map_of(storey).grid();
  std::vector<Eigen::Vector2d> visited_M;
  for (const KeyframeVertex& keyframe : graph.keyframes)
    if (keyframe.storey == storey) visited_M.emplace_back(keyframe.X_MR.t.head<2>());
  const std::vector<RoomCandidate> found =
      detect_rooms(grid, clusters(grid, config_.clusters), walls, visited_M, config_.rooms);
  const std::vector<int> ids = tie(graph, storey, found);
  std::erase_if(graph.room_factors,
                [&](const RoomFactor& f) { return graph.rooms[static_cast<std::size_t>(f.room)].storey == storey; });
  const double weight = 1.0 / (config_.sigma_m * config_.sigma_m);
  for (std::size_t k = 0; k < found.size(); ++k)
    graph.room_factors.push_back({.room = ids[k],
                                  .planes = found[k].planes,
                                  .cluster_M = found[k].cluster_M,
                                  .height_M = graph.keyframes.back().X_MR.t.z(),
                                  .information = weight * Eigen::Matrix2d::Identity()});
}

void RoomLayer::redraw(const Graph& graph) {
  for (auto& [storey, map] : maps_) map.clear();
  for (std::size_t k = 0; k < looks_.size(); ++k) {
    looks_[k].X_MR = graph.keyframes[k].X_MR;
    map_of(looks_[k].storey).carve(looks_[k].rays, looks_[k].X_MR);
  }
}

std::vector<RoomNode> RoomLayer::nodes(const Graph& graph) const {
  std::vector<RoomNode> nodes;
  for (std::size_t id = 0; id < candidates_.size(); ++id) {
    if (!graph.rooms[id].found) continue;
    const RoomCandidate& room = candidates_[id];
    nodes.push_back({static_cast<int>(id), room.kind, graph.rooms[id].center_M, room.polygon_M, room.planes});
  }
  return nodes;
}

void RoomLayer::redraw_if_moved(const Graph& graph) {
  for (std::size_t k = 0; k < looks_.size(); ++k) {
    if ((graph.keyframes[k].X_MR.t - looks_[k].X_MR.t).norm() <= config_.redraw_m) continue;
    redraw(graph);
    return;
  }
}

std::vector<int> RoomLayer::tie(Graph& graph, int storey, const std::vector<RoomCandidate>& found) {
  std::vector<Polygon2> known_M;
  std::vector<int> known_ids;
  for (std::size_t id = 0; id < candidates_.size(); ++id) {
    if (graph.rooms[id].storey != storey) continue;
    known_M.push_back(candidates_[id].polygon_M);
    known_ids.push_back(static_cast<int>(id));
    graph.rooms[id].found = false;
  }
  std::vector<int> ids = associate_rooms(known_M, found, config_.same_overlap);
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (ids[k] >= 0) {
      ids[k] = known_ids[static_cast<std::size_t>(ids[k])];
    } else {
      ids[k] = static_cast<int>(graph.rooms.size());
      graph.rooms.push_back({.storey = storey});
      candidates_.emplace_back();
    }
    const auto id = static_cast<std::size_t>(ids[k]);
    graph.rooms[id] = {found[k].kind, found[k].center_M, storey, true};
    candidates_[id] = found[k];
  }
  return ids;
}

FreeSpaceMap& RoomLayer::map_of(int storey) { return maps_.try_emplace(storey, config_.free_space).first->second; }

}  // namespace plumbline::slam
