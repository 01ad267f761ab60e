// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/replay/replay_scene.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

namespace plumbline::scenarios {

namespace {

constexpr double mm = 0.001;
constexpr std::array<std::string_view, 5> kind_names = {"wall", "slab", "column", "stair", "obstacle"};

Tree point(const Eigen::Vector2d& p, const Eigen::Vector3d& origin) {
  return Tree(Tree::List{whole(p.x() - origin.x(), mm), whole(p.y() - origin.y(), mm)});
}

Tree outline(const Polygon2& polygon, const Eigen::Vector3d& origin) {
  Tree list = Tree::list();
  for (const Eigen::Vector2d& p : polygon) list.push(point(p, origin));
  return list;
}

Tree storeys_of(const bim::Plan& plan, const Eigen::Vector3d& origin) {
  Tree list = Tree::list();
  for (const bim::PlanStorey& storey : plan.storeys)
    list.push(Tree::map()
                  .set("name", storey.name)
                  .set("z", whole(storey.elevation_m - origin.z(), mm))
                  .set("h", whole(storey.height_m, mm)));
  return list;
}

Tree rooms_of(const bim::Plan& plan, const Eigen::Vector3d& origin) {
  Tree list = Tree::list();
  for (const bim::PlanRoom& room : plan.rooms)
    list.push(Tree::map().set("name", room.name).set("s", room.storey).set("at", outline(room.polygon, origin)));
  return list;
}

Tree faces_of(const bim::Plan& plan, const Eigen::Vector3d& origin) {
  Tree list = Tree::list();
  for (const bim::PlanFace& face : plan.faces) {
    Tree holes = Tree::list();
    for (const bim::FaceHole& hole : face.holes)
      holes.push(Tree(Tree::List{whole(hole.s0, mm), whole(hole.s1, mm), whole(hole.z0 - origin.z(), mm),
                                 whole(hole.z1 - origin.z(), mm)}));
    list.push(Tree::map()
                  .set("id", face.id)
                  .set("wall", face.wall_id)
                  .set("s", face.storey)
                  .set("p", point(face.p0, origin))
                  .set("q", point(face.p1, origin))
                  .set("z", Tree(Tree::List{whole(face.z0 - origin.z(), mm), whole(face.z1 - origin.z(), mm)}))
                  .set("holes", std::move(holes)));
  }
  return list;
}

/// Columns and planned furniture, as their outlines: like faces, of no wall.
void add_solids(const bim::Plan& plan, const Eigen::Vector3d& origin, Tree& faces) {
  for (const bim::PlanSolid& solid : plan.solids)
    for (std::size_t i = 0; i < solid.outline.size(); ++i)
      faces.push(Tree::map()
                     .set("id", -1)
                     .set("wall", solid.id)
                     .set("s", solid.storey)
                     .set("p", point(solid.outline[(i + 1) % solid.outline.size()], origin))
                     .set("q", point(solid.outline[i], origin))
                     .set("z", Tree(Tree::List{whole(solid.z0 - origin.z(), mm), whole(solid.z1 - origin.z(), mm)}))
                     .set("holes", Tree::list()));
}

/// The architectural graph of the plan: rooms as [name, storey, x, y], pairs of a room and a face that bounds it, pairs
/// of rooms that a door or void joins.
Tree plan_graph(const bim::Plan& plan, const Eigen::Vector3d& origin) {
  Tree rooms = Tree::list(), bounds = Tree::list(), doors = Tree::list();
  for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
    const bim::PlanRoom& room = plan.rooms[i];
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& p : room.polygon) middle += p / static_cast<double>(room.polygon.size());
    rooms.push(Tree(
        Tree::List{room.name, room.storey, whole(middle.x() - origin.x(), mm), whole(middle.y() - origin.y(), mm)}));
    for (const int face : room.faces) bounds.push(static_cast<int>(i)).push(face);
    for (const int other : room.neighbours)
      if (other > static_cast<int>(i)) doors.push(static_cast<int>(i)).push(other);
  }
  return Tree::map()
      .set("rooms", std::move(rooms))
      .set("room_face", std::move(bounds))
      .set("room_room", std::move(doors));
}

Tree elements_of(const bim::BuildingMesh& mesh) {
  Tree list = Tree::list();
  for (const bim::MeshElement& element : mesh.elements)
    list.push(Tree(Tree::List{element.id, kind_names.at(static_cast<std::size_t>(element.kind)), element.storey,
                              element.first_triangle, element.triangle_count, element.closed}));
  return list;
}

Tree deviations_of(const ReportInput& input, const Eigen::Vector3d& origin) {
  Tree list = Tree::list();
  for (const ReportStorey& storey : input.storeys)
    for (const ReportDeviation& deviation : storey.deviations)
      list.push(Tree::map()
                    .set("text", describe(deviation))
                    .set("id", deviation.element)
                    .set("s", storey.index)
                    .set("planned", outline(deviation.planned_W, origin))
                    .set("built", outline(deviation.built_W, origin)));
  return list;
}

template <class Value>
void append(std::string& bytes, Value value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  for (unsigned k = 0; k < 4; ++k) bytes += static_cast<char>(bits >> (8 * k) & 0xFFU);
}

}  // namespace

Tree whole(double value, double unit) { return Tree(static_cast<std::int64_t>(std::llround(value / unit))); }

void DeltaColumn::add(double value) {
  const auto here = static_cast<std::int64_t>(std::llround(value / unit_));
  list_.push(Tree(here - std::exchange(before_, here)));
}

Eigen::Vector3d replay_origin(const FinishedRun& run) {
  const std::vector<Eigen::Vector3d>& vertices = run.building->mesh_as_built().vertices;
  if (vertices.empty()) return Eigen::Vector3d::Zero();
  Eigen::Vector3d low = vertices.front(), high = low;
  for (const Eigen::Vector3d& p : vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (0.5 * (low + high)).array().round();
}

Tree replay_scene(const FinishedRun& run, const ReportInput& input, const Eigen::Vector3d& origin) {
  const bim::Plan& planned = *run.building->plan_as_planned();
  Tree at = Tree::list(), faces = faces_of(planned, origin);
  add_solids(planned, origin, faces);
  for (int k = 0; k < 3; ++k) at.push(origin[k]);
  return Tree::map()
      .set("origin", std::move(at))
      .set("storeys", storeys_of(input.plan, origin))
      .set("rooms", rooms_of(input.plan, origin))
      .set("faces", std::move(faces))
      .set("plangraph", plan_graph(planned, origin))
      .set("elements", elements_of(run.building->mesh_as_built()))
      .set("deviations", deviations_of(input, origin));
}

std::string replay_mesh(const FinishedRun& run, const Eigen::Vector3d& origin) {
  const bim::BuildingMesh& mesh = run.building->mesh_as_built();
  std::string bytes;
  bytes.reserve(12 * (mesh.vertices.size() + mesh.triangles.size()));
  for (const Eigen::Vector3d& p : mesh.vertices)
    for (int k = 0; k < 3; ++k) append(bytes, static_cast<float>(p[k] - origin[k]));
  for (const Eigen::Vector3i& triangle : mesh.triangles)
    for (int k = 0; k < 3; ++k) append(bytes, static_cast<std::uint32_t>(triangle[k]));
  return bytes;
}

}  // namespace plumbline::scenarios
