// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/observed_walls.h"

#include <algorithm>

#include "slam/localization/associate.h"

namespace plumbline::slam {

namespace {

// A room counts as entered from this many poses on, 0.2 m apart.
constexpr int visits_min = 3;

}  // namespace

void ObservedWalls::add(const StoreyIndex& storey, const TrackedPose& pose) {
  if (pose.room >= 0) add_room(storey.rooms[static_cast<std::size_t>(pose.room)]);
  for (const WallLink& link : pose.walls) add_wall(storey, pose, link);
}

void ObservedWalls::add_room(const LocalRoom& room) {
  const auto known =
      std::find_if(rooms_.begin(), rooms_.end(), [&](const Room& r) { return r.plan_room == room.plan_room; });
  if (known == rooms_.end())
    rooms_.push_back({room.plan_room, room.polygon, 1});
  else
    ++known->visits;
}

void ObservedWalls::add_wall(const StoreyIndex& storey, const TrackedPose& pose, const WallLink& link) {
  const WallLine& planned = storey.lines[static_cast<std::size_t>(link.line)];
  const Eigen::Vector3d p0_I = pose.X_IR * link.observed.p0_R, p1_I = pose.X_IR * link.observed.p1_R;
  const double a = planned.e.dot(p0_I.head<2>() - planned.a), b = planned.e.dot(p1_I.head<2>() - planned.a);
  const double z0 = pose.X_IR.t.z() + link.observed.z0, z1 = pose.X_IR.t.z() + link.observed.z1;
  auto wall = std::find_if(walls_.begin(), walls_.end(),
                           [&](const Wall& w) { return w.plan_storey == storey.plan_storey && w.line == link.line; });
  if (wall == walls_.end())
    wall = walls_.insert(walls_.end(),
                         {storey.plan_storey, link.line, planned, 0.0, std::min(a, b), std::max(a, b), z0, z1, 0});
  const Eigen::Vector3d center_I = pose.X_IR * link.observed.centroid_R;
  wall->offset_sum += planned.n.dot(center_I.head<2>()) + planned.d;
  wall->s0 = std::min({wall->s0, a, b});
  wall->s1 = std::max({wall->s1, a, b});
  wall->z0 = std::min(wall->z0, z0);
  wall->z1 = std::max(wall->z1, z1);
  ++wall->observations;
}

std::vector<PlaneNode> ObservedWalls::planes(const Pose& X_WI) const {
  std::vector<PlaneNode> nodes;
  for (const Wall& wall : walls_) {
    const double offset = wall.offset_sum / wall.observations;
    Plane plane_I = plane_of(wall.planned);
    plane_I.d -= offset;
    PlaneNode node;
    node.id = static_cast<int>(nodes.size());
    node.plane_F = X_WI * plane_I;
    const auto at = [&](double s) -> Eigen::Vector2d {
      const Eigen::Vector2d p_I = wall.planned.a + s * wall.planned.e + offset * wall.planned.n;
      return (X_WI * Eigen::Vector3d(p_I.x(), p_I.y(), 0.0)).head<2>();
    };
    node.p0 = at(wall.s0);
    node.p1 = at(wall.s1);
    node.z0 = wall.z0 + X_WI.t.z();
    node.z1 = wall.z1 + X_WI.t.z();
    node.observations = wall.observations;
    nodes.push_back(node);
  }
  return nodes;
}

std::vector<RoomNode> ObservedWalls::rooms(const Pose& X_WI) const {
  std::vector<RoomNode> nodes;
  for (const Room& room : rooms_) {
    if (room.visits < visits_min) continue;
    RoomNode node;
    node.id = static_cast<int>(nodes.size());
    for (const Eigen::Vector2d& p_I : room.polygon)
      node.polygon_F.push_back((X_WI * Eigen::Vector3d(p_I.x(), p_I.y(), 0.0)).head<2>());
    if (signed_area(node.polygon_F) < 0.0) std::reverse(node.polygon_F.begin(), node.polygon_F.end());
    node.center_F = centroid(node.polygon_F);
    nodes.push_back(node);
  }
  return nodes;
}

}  // namespace plumbline::slam
