// SPDX-License-Identifier: Apache-2.0
#include "bim/plan/plan.h"

#include <algorithm>
#include <optional>

#include "bim/errors.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/mesh/solid.h"
#include "bim/mesh/visible.h"
#include "bim/model/boxes.h"
#include "bim/model/fillings.h"
#include "bim/model/hull.h"
#include "bim/model/permanence.h"
#include "bim/model/rooms.h"
#include "bim/model/through.h"
#include "bim/model/wall_face.h"

namespace plumbline::bim {

namespace {

constexpr double filled_min = 0.9;  ///< least share of its upright prism that a solid of the plan fills

/// The opening as a rectangle of one side, cut off where it reaches beyond the face.
FaceHole hole_of(const Opening& opening, const Wall& wall, int side) {
  const double centre = side == 0 ? opening.s_m : wall.length() - opening.s_m;
  FaceHole hole;
  hole.s0 = std::max(0.0, centre - 0.5 * opening.width_m);
  hole.s1 = std::min(wall.length(), centre + 0.5 * opening.width_m);
  hole.z0 = std::max(wall.z0_m, opening.z0_m);
  hole.z1 = std::min(wall.z1_m, opening.z1_m);
  return hole;
}

PlanFace face_of(const Building& building, int wall_index, int side) {
  const Wall& wall = building.walls[static_cast<std::size_t>(wall_index)];
  const FaceLine line = face_line(wall, side);
  PlanFace face;
  face.id = 2 * wall_index + side;
  face.wall_id = wall.id;
  face.side = side;
  face.storey = wall.storey;
  face.plane_W = face_plane(wall, side);
  face.p0 = line.p0;
  face.p1 = line.p1;
  face.z0 = wall.z0_m;
  face.z1 = wall.z1_m;
  for (const Opening& opening : building.openings) {
    if (opening.wall != wall_index || !opens_on(opening, wall, side)) continue;
    const FaceHole hole = hole_of(opening, wall, side);
    if (hole.s1 > hole.s0 && hole.z1 > hole.z0) face.holes.push_back(hole);
  }
  std::stable_sort(face.holes.begin(), face.holes.end(),
                   [](const FaceHole& a, const FaceHole& b) { return a.s0 < b.s0; });
  return face;
}

PlanRoom room_of(const Room& room, int index) {
  PlanRoom result;
  result.id = index;
  result.name = room.id;
  result.storey = room.storey;
  result.polygon = room.polygon;
  result.holes = room.holes;
  result.z0 = room.z0_m;
  result.z1 = room.z1_m;
  return result;
}

/// Joins each room with the sides of its walls that face it.
void link_faces(const Building& building, Plan& plan) {
  for (PlanRoom& room : plan.rooms) {
    const Room& source = building.rooms[static_cast<std::size_t>(room.id)];
    for (const int wall : source.walls) {
      for (const int side : bounding_sides(source, building.walls[static_cast<std::size_t>(wall)])) {
        room.faces.push_back(2 * wall + side);
        plan.faces[static_cast<std::size_t>(2 * wall + side)].rooms.push_back(room.id);
      }
    }
    std::sort(room.faces.begin(), room.faces.end());
  }
}

void join(Plan& plan, int a, int b) {
  if (a < 0 || b < 0 || a == b) return;
  plan.rooms[static_cast<std::size_t>(a)].neighbours.push_back(b);
  plan.rooms[static_cast<std::size_t>(b)].neighbours.push_back(a);
}

/// Rooms meet through doors and voids, and where nothing stands between them.
void link_rooms(const Building& building, Plan& plan) {
  for (const Opening& opening : building.openings)
    if (opening.kind != OpeningKind::window) join(plan, opening.rooms[0], opening.rooms[1]);
  const AdjacencyConfig config;
  const BoxIndex boxes = boxes_of(building.rooms);
  for (std::size_t i = 0; i < building.rooms.size(); ++i)
    for (const int j : boxes.near(building.rooms[i].polygon, config.virtual_gap_m))
      if (j > static_cast<int>(i) &&
          open_length(building.rooms[i], building.rooms[static_cast<std::size_t>(j)], config) > config.overlap_m)
        join(plan, static_cast<int>(i), j);
  for (std::size_t i = 0; i < building.rooms.size(); ++i)
    for (const VirtualEdge& edge : building.rooms[i].virtual_edges) join(plan, static_cast<int>(i), edge.room);
  for (PlanRoom& room : plan.rooms) {
    std::sort(room.neighbours.begin(), room.neighbours.end());
    room.neighbours.erase(std::unique(room.neighbours.begin(), room.neighbours.end()), room.neighbours.end());
  }
}

/// The obstacle as the upright prism around it, or nothing where it is mostly air: light passes under a table.
std::optional<PlanSolid> solid_of(const Obstacle& obstacle) {
  if (!obstacle.planned || is_filling(obstacle) || obstacle.body.vertices.empty()) return std::nullopt;
  const auto [low, high] = std::minmax_element(obstacle.body.vertices.begin(), obstacle.body.vertices.end(),
                                               [](const auto& p, const auto& q) { return p.z() < q.z(); });
  PlanSolid solid{obstacle.id, obstacle.storey, {}, low->z(), high->z(), may_have_moved(obstacle)};
  for (const Eigen::Vector3d& p : obstacle.body.vertices) solid.outline.emplace_back(p.head<2>());
  solid.outline = convex_hull(std::move(solid.outline));
  if (solid.outline.empty()) return std::nullopt;
  const double hull_volume = signed_area(solid.outline) * (solid.z1 - solid.z0);
  if (volume(obstacle.body) < filled_min * hull_volume) return std::nullopt;
  return solid;
}

/// Whether a column is the upright prism over what it covers, unlike one that leans or widens at its head. Of a body
/// that does not close nobody knows.
bool is_prism(const Column& column) {
  if (!column.body || !is_closed(*column.body)) return true;
  std::vector<Polygon2> tops;
  for (const Eigen::Vector3i& t : column.body->triangles) {
    Polygon2 seen;
    for (const int i : t) seen.emplace_back(column.body->vertices[static_cast<std::size_t>(i)].head<2>());
    if (signed_area(seen) > 0.0) tops.push_back(std::move(seen));
  }
  return volume(*column.body) >= filled_min * area(unite(tops)) * (column.z1_m - column.z0_m);
}

std::vector<PlanSolid> solids_of(const Building& building) {
  std::vector<PlanSolid> solids;
  for (const Column& column : building.columns) {
    if (column.footprint.size() < 3 || !is_prism(column)) continue;
    solids.push_back({column.id, column.storey, column.footprint, column.z0_m, column.z1_m});
    if (signed_area(column.footprint) < 0.0) std::reverse(solids.back().outline.begin(), solids.back().outline.end());
  }
  for (const Obstacle& obstacle : building.obstacles)
    if (std::optional<PlanSolid> solid = solid_of(obstacle)) solids.push_back(std::move(*solid));
  return solids;
}

/// Triangles of what was built to stay, and of nothing that may have moved, or the other way round, with the vertices
/// they need.
BuildingMesh part_of(const Building& building, const BuildingMesh& visible, bool movable) {
  BuildingMesh part;
  part.elements = visible.elements;
  std::vector<int> vertex_of(visible.vertices.size(), -1);
  for (MeshElement& element : part.elements) {
    const int first = element.first_triangle, count = element.triangle_count;
    element.first_triangle = static_cast<int>(part.triangles.size());
    element.triangle_count = 0;
    const Obstacle* obstacle =
        element.kind == ElementKind::obstacle ? &building.obstacles[static_cast<std::size_t>(element.index)] : nullptr;
    if (obstacle != nullptr && is_filling(*obstacle)) continue;
    if (movable != (obstacle != nullptr && may_have_moved(*obstacle))) continue;
    if (movable && !obstacle->planned) continue;
    element.triangle_count = count;
    for (int i = first; i < first + count; ++i) {
      Eigen::Vector3i triangle = visible.triangles[static_cast<std::size_t>(i)];
      for (int& vertex : triangle.reshaped()) {
        int& kept_as = vertex_of[static_cast<std::size_t>(vertex)];
        if (kept_as < 0) {
          kept_as = static_cast<int>(part.vertices.size());
          part.vertices.push_back(visible.vertices[static_cast<std::size_t>(vertex)]);
        }
        vertex = kept_as;
      }
      part.triangles.push_back(triangle);
      part.element.push_back(static_cast<int>(&element - part.elements.data()));
    }
  }
  return part;
}

std::optional<WalkedFloors> floors_of(const Building& building, int storey) {
  WalkedFloors floors = walked_floors(building, storey);
  const bool level =
      floors.raised.empty() && floors.ground_m == building.storeys[static_cast<std::size_t>(storey)].elevation_m;
  return level ? std::nullopt : std::optional(std::move(floors));
}

Eigen::Vector2d moved(const Pose& X_VW, const Eigen::Vector2d& p_W) {
  return (X_VW * Eigen::Vector3d(p_W.x(), p_W.y(), 0.0)).head<2>();
}

}  // namespace

Plan make_plan(const Building& as_planned) { return make_plan(as_planned, build_mesh(as_planned)); }

Plan make_plan(const Building& as_planned, const BuildingMesh& mesh) {
  Plan plan;
  for (std::size_t i = 0; i < as_planned.storeys.size(); ++i) {
    const Storey& storey = as_planned.storeys[i];
    plan.storeys.push_back(
        {storey.id, storey.elevation_m, storey.height_m, floors_of(as_planned, static_cast<int>(i))});
  }
  for (std::size_t wall = 0; wall < as_planned.walls.size(); ++wall)
    for (const int side : {0, 1}) plan.faces.push_back(face_of(as_planned, static_cast<int>(wall), side));
  for (std::size_t room = 0; room < as_planned.rooms.size(); ++room)
    plan.rooms.push_back(room_of(as_planned.rooms[room], static_cast<int>(room)));
  link_faces(as_planned, plan);
  link_rooms(as_planned, plan);
  plan.solids = solids_of(as_planned);
  const BuildingMesh visible = visible_mesh(as_planned, mesh);
  plan.structure = part_of(as_planned, visible, false);
  plan.furniture = part_of(as_planned, visible, true);
  return plan;
}

Plan transformed(const Plan& plan_W, const Pose& X_VW) {
  constexpr double level = 1e-9;
  if ((X_VW.q * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitZ()).norm() > level)
    throw InternalError("a plan turns about the vertical only");
  const double rise = X_VW.t.z();
  Plan plan_V = plan_W;
  for (PlanStorey& storey : plan_V.storeys) {
    storey.elevation_m += rise;
    if (storey.floors) storey.floors = moved(X_VW, std::move(*storey.floors));
  }
  for (PlanFace& face : plan_V.faces) {
    face.plane_W = X_VW * face.plane_W;
    face.p0 = moved(X_VW, face.p0);
    face.p1 = moved(X_VW, face.p1);
    face.z0 += rise;
    face.z1 += rise;
    for (FaceHole& hole : face.holes) {
      hole.z0 += rise;
      hole.z1 += rise;
    }
  }
  for (PlanRoom& room : plan_V.rooms) {
    for (Eigen::Vector2d& p : room.polygon) p = moved(X_VW, p);
    for (Polygon2& hole : room.holes)
      for (Eigen::Vector2d& p : hole) p = moved(X_VW, p);
    room.z0 += rise;
    room.z1 += rise;
  }
  for (PlanSolid& solid : plan_V.solids) {
    for (Eigen::Vector2d& p : solid.outline) p = moved(X_VW, p);
    solid.z0 += rise;
    solid.z1 += rise;
  }
  for (BuildingMesh* mesh : {&plan_V.structure, &plan_V.furniture})
    for (Eigen::Vector3d& p : mesh->vertices) p = X_VW * p;
  return plan_V;
}

}  // namespace plumbline::bim
