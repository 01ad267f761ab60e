// SPDX-License-Identifier: Apache-2.0
#include "slam/mapping/room_layer.h"

#include <algorithm>
#include <cmath>

namespace plumbline::slam {

namespace {

constexpr double same_axis_cos = 0.9;  ///< of two corridors that may be one

/// The plane that a plane has become part of, or itself.
int merge_root(const Graph& graph, int plane) {
  while (graph.planes[static_cast<std::size_t>(plane)].merged_into >= 0)
    plane = graph.planes[static_cast<std::size_t>(plane)].merged_into;
  return plane;
}

/// False where walls of a room that should face each other, or meet, have become one.
bool has_distinct_walls(const RoomFactor& factor) {
  const auto plane = [&](int i) { return factor.planes[static_cast<std::size_t>(i)]; };
  if (!factor.corners.empty())
    return std::all_of(factor.corners.begin(), factor.corners.end(),
                       [&](const RoomCorner& corner) { return plane(corner[0]) != plane(corner[1]); });
  std::vector<int> planes = factor.planes;
  std::sort(planes.begin(), planes.end());
  return std::adjacent_find(planes.begin(), planes.end()) == planes.end();
}

}  // namespace

void RoomLayer::add_scan(const Graph& graph, const DeskewedScan& scan, std::span<const PlaneObservation> seen) {
  if (config_.source == RoomSource::keyframe) return;
  const KeyframeVertex& keyframe = graph.keyframes.back();
  const Eigen::Vector3d up_R = keyframe.X_MR.q.conjugate() * Eigen::Vector3d::UnitZ();
  free_space_scans_.push_back({free_rays(scan, up_R, config_.free_space), keyframe.X_MR, keyframe.storey});
  free_space_scans_.back().rays.wall_R = wall_points(scan, seen, config_.free_space);
  map_of(keyframe.storey).carve(free_space_scans_.back().rays, keyframe.X_MR);
}

void RoomLayer::update(Graph& graph, int storey, std::span<const PlaneNode> walls) {
  if (config_.source != RoomSource::free_space) return;
  rebuild_if_moved(graph);
  const Partition& partition = partition_of(storey);
  std::vector<Eigen::Vector2d> visited_M;
  for (const KeyframeVertex& keyframe : graph.keyframes)
    if (keyframe.storey == storey) visited_M.emplace_back(keyframe.X_MR.t.head<2>());
  const std::vector<RoomCandidate> found =
      detect_rooms(partition.grid, partition.clusters, walls, visited_M, config_.rooms);
  const std::vector<int> ids = associate(graph, storey, found);
  std::erase_if(graph.room_factors,
                [&](const RoomFactor& f) { return graph.rooms[static_cast<std::size_t>(f.room)].storey == storey; });
  for (std::size_t k = 0; k < found.size(); ++k) graph.room_factors.push_back(factor_of(graph, ids[k], found[k]));
}

RoomFactor RoomLayer::factor_of(const Graph& graph, int id, const RoomCandidate& room) const {
  const double sigma_m = room.kind == RoomKind::two_wall ? config_.two_wall_sigma_m : config_.sigma_m;
  return {.room = id,
          .planes = room.planes,
          .cluster_M = room.cluster_M,
          .height_M = graph.keyframes.back().X_MR.t.z(),
          .information = Eigen::Matrix2d::Identity() / (sigma_m * sigma_m),
          .corners = room.corners};
}

std::vector<RoomCandidate> RoomLayer::rooms_round(const Graph& graph, std::span<const PlaneNode> seen_M) {
  const KeyframeVertex& keyframe = graph.keyframes.back();
  const Eigen::Vector2d robot_M = keyframe.X_MR.t.head<2>();
  if (config_.source == RoomSource::keyframe)
    return keyframe_rooms(seen_M, robot_M, config_.rooms, config_.keyframe_rooms);
  rebuild_if_moved(graph);
  const Partition& partition = partition_of(keyframe.storey);
  return detect_rooms(partition.grid, partition.clusters, seen_M, std::span(&robot_M, 1), config_.rooms);
}

// The centre of a two-wall room says nothing along it [bavle2023, section IV-C].
int RoomLayer::known_by_center(const Graph& graph, const RoomCandidate& room) const {
  int known = -1;
  double nearest_m = config_.same_center_m;
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    if (!graph.rooms[k].found || graph.rooms[k].storey != graph.keyframes.back().storey) continue;
    Eigen::Vector2d off = graph.rooms[k].center_M - room.center_M;
    if (config_.source == RoomSource::keyframe_clusters && room.kind == RoomKind::two_wall &&
        candidates_[k].kind == RoomKind::two_wall) {
      const auto normal = [&](const RoomCandidate& r) {
        return Eigen::Vector2d(
            graph.planes[static_cast<std::size_t>(r.planes.front())].plane_M.n.head<2>().normalized());
      };
      if (std::abs(normal(room).dot(normal(candidates_[k]))) < same_axis_cos) continue;
      off = normal(room) * normal(room).dot(off);
    }
    if (off.norm() >= nearest_m) continue;
    nearest_m = off.norm();
    known = static_cast<int>(k);
  }
  return known;
}

// A room is known again by its kind and centre [bavle2023, section IV-C]; the walls of the latest detection replace the
// former ones, or, as printed, each look adds a factor. A two-wall room inside a four-wall one gives way to it
// [lsg2022].
void RoomLayer::add_from_keyframe(Graph& graph, std::span<const PlaneNode> seen_M) {
  if (config_.source == RoomSource::free_space) return;
  const int storey = graph.keyframes.back().storey;
  for (const RoomCandidate& room : rooms_round(graph, seen_M)) {
    int id = known_by_center(graph, room);
    const bool known = id >= 0;
    if (known && candidates_[static_cast<std::size_t>(id)].kind == RoomKind::four_wall &&
        room.kind == RoomKind::two_wall)
      continue;
    if (!known) {
      id = static_cast<int>(graph.rooms.size());
      graph.rooms.push_back({.storey = storey});
      candidates_.emplace_back();
    }
    RoomCandidate& latest = candidates_[static_cast<std::size_t>(id)];
    const bool each_look = known && config_.source == RoomSource::keyframe_clusters && latest.kind == room.kind;
    RoomVertex& vertex = graph.rooms[static_cast<std::size_t>(id)];
    if (!each_look) {
      vertex = {room.kind, room.center_M, storey, true};
      std::erase_if(graph.room_factors, [&](const RoomFactor& f) { return f.room == id; });
    }
    latest = room;
    graph.room_factors.push_back(factor_of(graph, id, room));
  }
}

std::vector<SameWall> RoomLayer::find_revisited_walls(const Graph& graph, std::span<const PlaneNode> seen_M,
                                                      const WallDistance& distance) const {
  const KeyframeVertex& keyframe = graph.keyframes.back();
  for (const RoomCandidate& room :
       keyframe_rooms(seen_M, keyframe.X_MR.t.head<2>(), config_.rooms, config_.keyframe_rooms))
    for (std::size_t id = 0; id < candidates_.size(); ++id) {
      const RoomVertex& known = graph.rooms[id];
      if (!known.found || known.storey != keyframe.storey || known.kind != room.kind) continue;
      std::vector<int> planes = candidates_[id].planes;
      for (int& plane : planes) plane = merge_root(graph, plane);
      if (std::optional<std::vector<SameWall>> same = same_walls(planes, room.planes, distance)) return *same;
    }
  return {};
}

// Rooms of free space are found anew on the robot's storey alone; those of others keep the walls that they were found
// by.
void RoomLayer::redirect_merged_planes(Graph& graph) {
  for (RoomFactor& factor : graph.room_factors)
    for (int& plane : factor.planes) plane = merge_root(graph, plane);
  std::erase_if(graph.room_factors, [](const RoomFactor& factor) { return !has_distinct_walls(factor); });
  if (config_.source == RoomSource::free_space) return;
  for (RoomCandidate& room : candidates_)
    for (int& plane : room.planes) plane = merge_root(graph, plane);
}

void RoomLayer::rebuild_free_space(const Graph& graph) {
  partitions_.clear();
  for (auto& [storey, map] : maps_) map.clear();
  for (std::size_t k = 0; k < free_space_scans_.size(); ++k) {
    free_space_scans_[k].X_MR = graph.keyframes[k].X_MR;
    map_of(free_space_scans_[k].storey).carve(free_space_scans_[k].rays, free_space_scans_[k].X_MR);
  }
}

std::vector<RoomNode> RoomLayer::nodes(const Graph& graph) const {
  std::vector<RoomNode> nodes;
  for (std::size_t id = 0; id < candidates_.size(); ++id) {
    if (!graph.rooms[id].found) continue;
    const RoomCandidate& room = candidates_[id];
    const Eigen::Vector2d& center_M = graph.rooms[id].center_M;
    nodes.push_back({static_cast<int>(id), room.kind, center_M, room.polygon_M, room.planes});
    if (config_.source == RoomSource::free_space) continue;
    // Its keyframe drew it where the graph then had it.
    for (Eigen::Vector2d& p : nodes.back().polygon_F) p += center_M - room.center_M;
  }
  return nodes;
}

void RoomLayer::rebuild_if_moved(const Graph& graph) {
  for (std::size_t k = 0; k < free_space_scans_.size(); ++k) {
    if ((graph.keyframes[k].X_MR.t - free_space_scans_[k].X_MR.t).norm() <= config_.rebuild_distance_m) continue;
    rebuild_free_space(graph);
    return;
  }
}

std::vector<int> RoomLayer::associate(Graph& graph, int storey, const std::vector<RoomCandidate>& found) {
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

const RoomLayer::Partition& RoomLayer::partition_of(int storey) {
  Partition& known = partitions_[storey];
  FreeGrid seen = map_of(storey).seen_free();
  const double cell_m2 = seen.frame.cell * seen.frame.cell;
  if (static_cast<double>(changed_cells(known.seen, seen)) * cell_m2 < config_.refresh_m2) return known;
  known.seen = std::move(seen);
  known.grid = without_islands(known.seen, config_.free_space);
  known.clusters = clusters(known.grid, config_.clusters);
  return known;
}

FreeSpaceMap& RoomLayer::map_of(int storey) { return maps_.try_emplace(storey, config_.free_space).first->second; }

}  // namespace plumbline::slam
