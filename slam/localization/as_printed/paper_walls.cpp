// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/as_printed/paper_walls.h"

#include <algorithm>
#include <cmath>

namespace plumbline::slam {

namespace {

/// The second face of a wall as printed: (-n, d + T) of its first, n.x + d = 0 [shaheer2023, eq. 2]. A face without a
/// first one stays where it is.
Plane second_face(const bim::Plan& plan, const bim::PlanFace& face) {
  for (const bim::PlanFace& first : plan.faces) {
    if (first.side != 0 || first.wall_id != face.wall_id || first.plane_W.n.dot(face.plane_W.n) > -0.999) continue;
    const double thickness = -first.plane_W.d - face.plane_W.d;
    return {-first.plane_W.n, first.plane_W.d + thickness};
  }
  return face.plane_W;
}

std::vector<int> merged(std::vector<int> walls) {
  std::sort(walls.begin(), walls.end());
  walls.erase(std::unique(walls.begin(), walls.end()), walls.end());
  return walls;
}

PaperRoom make_room(const bim::Plan& plan, const bim::PlanRoom& source, const std::vector<int>& wall_of_face) {
  PaperRoom room;
  room.polygon_W = source.polygon;
  room.low_W = room.high_W = source.polygon.front();
  for (const Eigen::Vector2d& p : source.polygon) {
    room.low_W = room.low_W.cwiseMin(p);
    room.high_W = room.high_W.cwiseMax(p);
  }
  const auto add = [&](const std::vector<int>& faces, std::vector<int>& walls) {
    for (const int face : faces)
      if (wall_of_face[static_cast<std::size_t>(face)] >= 0)
        walls.push_back(wall_of_face[static_cast<std::size_t>(face)]);
  };
  add(source.faces, room.walls);
  room.with_neighbours = room.walls;
  for (const int next : source.neighbours) add(plan.rooms[static_cast<std::size_t>(next)].faces, room.with_neighbours);
  room.walls = merged(room.walls);
  room.with_neighbours = merged(room.with_neighbours);
  return room;
}

}  // namespace

int PaperStorey::room_at(const Eigen::Vector2d& p_W, PaperVariant outline) const {
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    const PaperRoom& room = rooms[i];
    const bool in_box = (p_W.array() >= room.low_W.array()).all() && (p_W.array() <= room.high_W.array()).all();
    if (in_box && (outline == PaperVariant::printed || contains(room.polygon_W, p_W))) return static_cast<int>(i);
  }
  return -1;
}

PaperStorey make_paper_storey(const bim::Plan& plan_W, const StoreyIndex& storey, double band_m, PaperVariant faces) {
  PaperStorey out;
  const double z = plan_W.storeys[static_cast<std::size_t>(storey.plan_storey)].elevation_m + band_m;
  std::vector<int> wall_of_face(plan_W.faces.size(), -1);
  for (std::size_t i = 0; i < plan_W.faces.size(); ++i) {
    const bim::PlanFace& face = plan_W.faces[i];
    if (face.storey != storey.plan_storey || z < face.z0 || z > face.z1) continue;
    wall_of_face[i] = static_cast<int>(out.walls.size());
    out.all.push_back(wall_of_face[i]);
    const bool moved = faces == PaperVariant::printed && face.side == 1;
    out.walls.push_back({static_cast<int>(i), moved ? second_face(plan_W, face) : face.plane_W, face.p0, face.p1});
  }
  for (const LocalRoom& room : storey.rooms)
    out.rooms.push_back(make_room(plan_W, plan_W.rooms[static_cast<std::size_t>(room.plan_room)], wall_of_face));
  return out;
}

AnglePlane paper_form(const Plane& plane, PaperVariant form) {
  if (form == PaperVariant::corrected) return to_angles(plane);
  // n.x = d with d >= 0: the normal leads from the origin to the plane, whichever side it is seen from.
  AnglePlane away = to_angles(plane.d < 0.0 ? plane : plane.flipped());
  away.d = std::abs(away.d);
  return away;
}

Eigen::Vector3d paper_difference(const AnglePlane& observed, const AnglePlane& mapped, PaperVariant wrap) {
  const double azimuth = observed.azimuth - mapped.azimuth;
  return {wrap == PaperVariant::corrected ? wrap_angle(azimuth) : azimuth, observed.elevation - mapped.elevation,
          observed.d - mapped.d};
}

}  // namespace plumbline::slam
