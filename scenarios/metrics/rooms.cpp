// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <tuple>

#include "scenarios/metrics/storey.h"
#include "scenarios/metrics/structure.h"

namespace plumbline::scenarios::score {

namespace {

struct Candidate {
  double overlap = 0.0;
  int node = 0;  ///< index into Estimate::rooms
  int room = 0;  ///< index into Plan::rooms
  bool visited = false;
};

Polygon2 place(const Polygon2& polygon_F, const Pose& X_WF) {
  Polygon2 polygon_W;
  for (const Eigen::Vector2d& p : polygon_F) polygon_W.push_back((X_WF * Eigen::Vector3d(p.x(), p.y(), 0.0)).head<2>());
  return polygon_W;
}

/// Intersection over union; 0 for outlines that are no simple polygon.
double iou(const Polygon2& a, const Polygon2& b) {
  if (a.size() < 3 || b.size() < 3 || !is_simple(a) || !is_simple(b)) return 0.0;
  const double shared = intersection_area(a, b);
  const double joined = std::abs(signed_area(a)) + std::abs(signed_area(b)) - shared;
  return joined > 0.0 ? shared / joined : 0.0;
}

bool bounds(const bim::PlanRoom& room, int face) {
  return std::find(room.faces.begin(), room.faces.end(), face) != room.faces.end();
}

/// The face of the room that a found room's plane was matched with, or -1.
int face_of(const slam::Estimate& estimate, const WallScore& walls, int plane_id, const bim::PlanRoom& room) {
  for (std::size_t i = 0; i < estimate.planes.size(); ++i) {
    if (estimate.planes[i].id != plane_id) continue;
    for (const int face : walls.faces_of_plane[i])
      if (bounds(room, face)) return face;
  }
  return -1;
}

/// False for rooms whose walls stand on another storey; one that names no walls may be any.
bool same_storey(const slam::Estimate& estimate, const slam::RoomNode& node, const Pose& X_WF, const bim::Plan& plan,
                 const bim::PlanRoom& room) {
  const std::optional<double> height_F = height_of_room(estimate, node);
  if (!height_F || plan.storeys.empty()) return true;
  const double z_W = (X_WF * Eigen::Vector3d(node.center_F.x(), node.center_F.y(), *height_F)).z();
  return storey_of_height(plan.storeys, z_W) == room.storey;
}

/// Both faces of a corridor matched, and the centre in the middle between them, within the room along it.
bool corridor_matches(const slam::Estimate& estimate, const slam::RoomNode& node, const Pose& X_WF,
                      const bim::Plan& plan, const bim::PlanRoom& room, const WallScore& walls,
                      const StructureRules& rules) {
  if (node.planes.size() != 2) return false;
  const int first = face_of(estimate, walls, node.planes[0], room);
  const int second = face_of(estimate, walls, node.planes[1], room);
  if (first < 0 || second < 0) return false;
  const Eigen::Vector3d center_W = X_WF * Eigen::Vector3d(node.center_F.x(), node.center_F.y(), 0.0);
  const double d0 = plan.faces[static_cast<std::size_t>(first)].plane_W.distance(center_W);
  const double d1 = plan.faces[static_cast<std::size_t>(second)].plane_W.distance(center_W);
  const bool in_the_middle = std::abs(d0 - d1) <= 2.0 * rules.room_across_m;
  const Eigen::Vector2d p = center_W.head<2>();
  return in_the_middle && (contains(room.polygon, p) || boundary_distance(room.polygon, p) <= rules.room_across_m);
}

}  // namespace

std::vector<int> visited_rooms(const bim::Plan& as_built, const Truth& truth, const StructureRules& rules) {
  std::vector<int> visited;
  const auto needed = static_cast<slam::Nanoseconds>(std::llround(rules.visit_s * 1e9));
  for (const bim::PlanRoom& room : as_built.rooms) {
    slam::Nanoseconds since = -1;
    for (const slam::StampedPose& pose : truth.poses_W) {
      const Eigen::Vector3d& t = pose.X_FR.t;
      const bool inside = t.z() >= room.z0 && t.z() <= room.z1 && contains(room.polygon, room.holes, t.head<2>()) &&
                          boundary_distance(room.polygon, room.holes, t.head<2>()) >= rules.visit_inside_m;
      if (!inside) {
        since = -1;
        continue;
      }
      if (since < 0) since = pose.stamp;
      if (pose.stamp - since >= needed) {
        visited.push_back(room.id);
        break;
      }
    }
  }
  return visited;
}

RoomScore score_rooms(const slam::Estimate& estimate, const Pose& X_WF, const bim::Plan& as_built,
                      const WallScore& walls, const Truth& truth, const StructureRules& rules) {
  const std::vector<int> visited = visited_rooms(as_built, truth, rules);
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < estimate.rooms.size(); ++i) {
    const slam::RoomNode& node = estimate.rooms[i];
    const Polygon2 outline_W = place(node.polygon_F, X_WF);
    for (std::size_t j = 0; j < as_built.rooms.size(); ++j) {
      const bim::PlanRoom& room = as_built.rooms[j];
      if (!same_storey(estimate, node, X_WF, as_built, room)) continue;
      const double overlap = iou(outline_W, room.polygon);
      const bool corridor =
          node.kind == slam::RoomKind::two_wall && corridor_matches(estimate, node, X_WF, as_built, room, walls, rules);
      const bool was_there = std::find(visited.begin(), visited.end(), room.id) != visited.end();
      if (overlap >= rules.room_iou || corridor)
        candidates.push_back({overlap, static_cast<int>(i), static_cast<int>(j), was_there});
    }
  }
  // Of equal outlines one above the other, which a room without walls does not tell apart, the one the robot was in.
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(b.overlap, b.visited, a.node, a.room) < std::tie(a.overlap, a.visited, b.node, b.room);
  });

  RoomScore score;
  score.room_of_node.assign(estimate.rooms.size(), -1);
  std::vector<bool> taken(as_built.rooms.size(), false);
  for (const Candidate& c : candidates) {
    int& room_id = score.room_of_node[static_cast<std::size_t>(c.node)];
    const auto room = static_cast<std::size_t>(c.room);
    if (room_id >= 0 || taken[room]) continue;
    room_id = as_built.rooms[room].id;
    taken[room] = true;
    ++score.matched;
  }
  const auto found = std::count_if(visited.begin(), visited.end(), [&](int id) {
    return std::find(score.room_of_node.begin(), score.room_of_node.end(), id) != score.room_of_node.end();
  });
  score.visited = static_cast<int>(visited.size());
  score.found = static_cast<int>(estimate.rooms.size());
  if (score.found > 0) score.precision = static_cast<double>(score.matched) / score.found;
  if (score.visited > 0) score.recall = static_cast<double>(found) / score.visited;
  return score;
}

}  // namespace plumbline::scenarios::score
