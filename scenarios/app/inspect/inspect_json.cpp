// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <string_view>

#include "bim/config/number_list.h"
#include "bim/digest/digest.h"
#include "bim/mesh/solid.h"
#include "bim/model/adjacency.h"
#include "bim/model/boxes.h"
#include "bim/model/wall_frame.h"
#include "bim/plan/plan.h"
#include "scenarios/app/inspect/inspect.h"
#include "scenarios/app/inspect/inspect_symmetry.h"

namespace plumbline::scenarios {
namespace {

using bim::Building;
using bim::BuildingMesh;
using bim::ElementKind;
using bim::MeshElement;

Tree box_tree(const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return {};
  return Tree(Tree::List{number_list(box.min()), number_list(box.max())});
}

Tree polygon_tree(const Polygon2& polygon) {
  Tree list = Tree::list();
  for (const Eigen::Vector2d& p : polygon) list.push(number_list(p));
  return list;
}

std::string_view name_of(bim::Passage by) {
  constexpr std::string_view names[] = {"door", "window", "void", "open edge", "stair"};
  return names[static_cast<std::size_t>(by)];
}

std::string_view name_of(bim::StoreyKind kind) {
  constexpr std::string_view names[] = {"habitable", "foundation", "roof"};
  return names[static_cast<std::size_t>(kind)];
}

/// Writes the elements of one building.
class Inspector {
 public:
  Inspector(const Building& building, const BuildingMesh& mesh)
      : building_(building), mesh_(mesh), plan_(bim::make_plan(building, {})) {}

  [[nodiscard]] Tree inspect() const {
    Tree tree = Tree::map();
    tree.set("hash", hex64(building_.hash())).set("schema", building_.schema).set("unit", building_.unit);
    tree.set("storeys", storeys());
    tree.set("walls", elements(ElementKind::wall));
    tree.set("rooms", rooms());
    tree.set("doors", openings(bim::OpeningKind::door));
    tree.set("windows", openings(bim::OpeningKind::window));
    tree.set("openings", openings(std::nullopt));
    tree.set("slabs", elements(ElementKind::slab));
    tree.set("columns", elements(ElementKind::column));
    tree.set("stairs", elements(ElementKind::stair));
    tree.set("obstacles", elements(ElementKind::obstacle));
    tree.set("adjacency", adjacency());
    tree.set("symmetry", symmetry_json(building_, bim::analyse_symmetry(building_)));
    tree.set("warnings", warnings());
    return tree;
  }

 private:
  [[nodiscard]] Tree head(const std::string& id, std::int64_t step_id, int storey) const {
    Tree tree = Tree::map();
    tree.set("id", id);
    if (step_id != 0) tree.set("step_id", step_id);
    if (storey >= 0) tree.set("storey", building_.storeys[static_cast<std::size_t>(storey)].id);
    return tree;
  }

  [[nodiscard]] Tree storeys() const {
    Tree list = Tree::list();
    for (const bim::Storey& storey : building_.storeys) {
      Tree tree = head(storey.id, storey.step_id, -1);
      tree.set("name", storey.name).set("elevation_m", storey.elevation_m).set("height_m", storey.height_m);
      tree.set("kind", name_of(storey.kind));
      list.push(std::move(tree));
    }
    return list;
  }

  [[nodiscard]] std::int64_t step_id(const MeshElement& element) const {
    const auto i = static_cast<std::size_t>(element.index);
    switch (element.kind) {
      case ElementKind::wall:
        return building_.walls[i].step_id;
      case ElementKind::slab:
        return building_.slabs[i].step_id;
      case ElementKind::column:
        return building_.columns[i].step_id;
      case ElementKind::stair:
        return building_.stairs[i].step_id;
      case ElementKind::obstacle:
        return building_.obstacles[i].step_id;
    }
    return 0;
  }

  [[nodiscard]] Tree element_tree(const MeshElement& element) const {
    Tree tree = head(element.id, step_id(element), element.storey);
    if (element.closed) tree.set("volume_m3", element.volume_m3);
    tree.set("closed", element.closed);
    Eigen::AlignedBox3d box;
    for (int t = 0; t < element.triangle_count; ++t)
      for (const int corner : mesh_.triangles[static_cast<std::size_t>(element.first_triangle + t)])
        box.extend(mesh_.vertices[static_cast<std::size_t>(corner)]);
    tree.set("bbox", box_tree(box));
    if (element.kind == ElementKind::wall) add_wall(building_.walls[static_cast<std::size_t>(element.index)], tree);
    if (element.kind == ElementKind::stair) add_stair(building_.stairs[static_cast<std::size_t>(element.index)], tree);
    if (element.kind == ElementKind::obstacle) {
      const bim::Obstacle& obstacle = building_.obstacles[static_cast<std::size_t>(element.index)];
      tree.set("kind", obstacle.kind);
      if (!obstacle.material.empty()) tree.set("material", obstacle.material);
    }
    return tree;
  }

  void add_wall(const bim::Wall& wall, Tree& tree) const {
    tree.set("name", wall.name).set("a", number_list(wall.a)).set("b", number_list(wall.b));
    tree.set("thickness_m", wall.thickness_m).set("material", wall.material);
    Tree faces = Tree::list();
    for (const bim::PlanFace& face : plan_.faces) {
      if (face.wall_id != wall.id) continue;
      Tree face_tree = Tree::map();
      face_tree.set("n", number_list(face.plane_W.n)).set("d", face.plane_W.d);
      faces.push(std::move(face_tree));
    }
    tree.set("faces", std::move(faces));
  }

  void add_stair(const bim::Stair& stair, Tree& tree) const {
    const auto storey_id = [&](int storey) {
      return storey < 0 ? Tree() : Tree(building_.storeys[static_cast<std::size_t>(storey)].id);
    };
    tree.set("name", stair.name).set("from", storey_id(stair.from)).set("to", storey_id(stair.to));
    tree.set("rooms", Tree(Tree::List{room_id(stair.rooms[0]), room_id(stair.rooms[1])}));
    Tree flights = Tree::list();
    for (const bim::StairFlight& flight : stair.flights) {
      Tree flight_tree = Tree::map();
      flight_tree.set("start", number_list(flight.start)).set("yaw_rad", flight.yaw).set("width_m", flight.width_m);
      flight_tree.set("z0_m", flight.z0_m).set("steps", flight.steps).set("rise_m", flight.rise_m);
      flights.push(std::move(flight_tree.set("run_m", flight.run_m)));
    }
    Tree landings = Tree::list();
    for (const bim::Landing& landing : stair.landings) {
      Tree landing_tree = Tree::map();
      landings.push(std::move(landing_tree.set("polygon", polygon_tree(landing.polygon)).set("z_m", landing.z_m)));
    }
    tree.set("flights", std::move(flights)).set("landings", std::move(landings));
  }

  [[nodiscard]] Tree elements(ElementKind kind) const {
    Tree list = Tree::list();
    for (const MeshElement& element : mesh_.elements)
      if (element.kind == kind) list.push(element_tree(element));
    return list;
  }

  [[nodiscard]] Tree rooms() const {
    Tree list = Tree::list();
    for (std::size_t i = 0; i < building_.rooms.size(); ++i) {
      const bim::Room& room = building_.rooms[i];
      Tree tree = head(room.id, room.step_id, room.storey);
      const double area = room.area_m2();
      Eigen::AlignedBox3d box;
      for (const Eigen::Vector2d& p : room.polygon) {
        box.extend(Eigen::Vector3d(p.x(), p.y(), room.z0_m));
        box.extend(Eigen::Vector3d(p.x(), p.y(), room.z1_m));
      }
      tree.set("name", room.name).set("area_m2", area).set("volume_m3", area * (room.z1_m - room.z0_m));
      tree.set("closed", true).set("bbox", box_tree(box)).set("polygon", polygon_tree(room.polygon));
      if (!room.holes.empty()) {
        Tree holes = Tree::list();
        for (const Polygon2& hole : room.holes) holes.push(polygon_tree(hole));
        tree.set("holes", std::move(holes));
      }
      Tree faces = Tree::list();
      for (const int face_index : plan_.rooms[i].faces) {
        const bim::PlanFace& face = plan_.faces[static_cast<std::size_t>(face_index)];
        Tree face_tree = Tree::map();
        face_tree.set("wall", face.wall_id).set("side", face.side);
        faces.push(std::move(face_tree));
      }
      tree.set("faces", std::move(faces));
      list.push(std::move(tree.set("virtual_edges", virtual_edges(room))));
    }
    return list;
  }

  [[nodiscard]] Tree virtual_edges(const bim::Room& room) const {
    Tree list = Tree::list();
    for (const bim::VirtualEdge& edge : room.virtual_edges) {
      Tree tree = Tree::map();
      tree.set("a", number_list(edge.a)).set("b", number_list(edge.b)).set("room", room_id(edge.room));
      if (!edge.door.empty()) tree.set("door", edge.door);
      list.push(std::move(tree));
    }
    return list;
  }

  [[nodiscard]] Tree room_id(int room) const {
    return room < 0 ? Tree() : Tree(building_.rooms[static_cast<std::size_t>(room)].id);
  }

  [[nodiscard]] Tree opening_tree(const bim::Opening& opening) const {
    constexpr std::string_view kinds[] = {"door", "window", "void"};
    constexpr std::string_view leaves[] = {"open", "closed", "none"};
    const bim::Wall& wall = building_.walls[static_cast<std::size_t>(opening.wall)];
    Tree tree = head(opening.id, opening.step_id, wall.storey);
    Eigen::AlignedBox3d box;
    double volume = 0.0;
    bool closed = true;
    for (const bim::Solid& solid : bim::solids_of(opening)) {
      volume += bim::volume(solid);
      closed = closed && bim::is_closed(solid);
      box.extend(bim::box_of(solid));
    }
    if (!opening.solid) {
      volume = opening.width_m * (opening.z1_m - opening.z0_m) * wall.thickness_m;
      for (const double s : {opening.s_m - opening.width_m / 2, opening.s_m + opening.width_m / 2})
        for (const double y : {wall.offset_m, wall.offset_m + wall.thickness_m})
          for (const double z : {opening.z0_m, opening.z1_m}) box.extend(bim::WallFrame(wall).to_world({s, y, z}));
    }
    tree.set("volume_m3", volume).set("closed", closed).set("bbox", box_tree(box)).set("wall", wall.id);
    tree.set("kind", kinds[static_cast<std::size_t>(opening.kind)]);
    tree.set("leaf", leaves[static_cast<std::size_t>(opening.leaf)]);
    if (!opening.filling_id.empty()) tree.set("filling", opening.filling_id);
    tree.set("s_m", opening.s_m).set("width_m", opening.width_m);
    tree.set("rooms", Tree(Tree::List{room_id(opening.rooms[0]), room_id(opening.rooms[1])}));
    return tree;
  }

  [[nodiscard]] Tree openings(std::optional<bim::OpeningKind> kind) const {
    Tree list = Tree::list();
    for (const bim::Opening& opening : building_.openings)
      if (!kind || opening.kind == *kind) list.push(opening_tree(opening));
    if (kind != bim::OpeningKind::window) return list;
    // Those of a roof, and those that stand for themselves, are solids of their own.
    for (const MeshElement& element : mesh_.elements) {
      if (element.kind != ElementKind::obstacle) continue;
      const std::string& name = building_.obstacles[static_cast<std::size_t>(element.index)].kind;
      if (name == "roof_window" || name == "window") list.push(element_tree(element));
    }
    return list;
  }

  /// Pairs of rooms that meet, and how; null is outside.
  [[nodiscard]] Tree adjacency() const {
    Tree list = Tree::list();
    for (const bim::Adjacent& pair : bim::adjacency(building_)) {
      Tree tree = Tree::map();
      tree.set("rooms", Tree(Tree::List{room_id(pair.a), room_id(pair.b)})).set("by", name_of(pair.by));
      if (!pair.element.empty()) tree.set(pair.by == bim::Passage::stair ? "stair" : "opening", pair.element);
      list.push(std::move(tree.set("width_m", pair.width_m)));
    }
    return list;
  }

  [[nodiscard]] Tree warnings() const {
    Tree list = Tree::list();
    for (const auto* warnings : {&building_.warnings, &mesh_.warnings}) {
      for (const bim::Warning& warning : *warnings) {
        Tree tree = Tree::map();
        tree.set("element", warning.element).set("kind", warning.kind).set("text", warning.text);
        list.push(std::move(tree));
      }
    }
    return list;
  }

  const Building& building_;
  const BuildingMesh& mesh_;
  bim::Plan plan_;
};

}  // namespace

Tree inspect_json(const Building& building, const BuildingMesh& mesh) { return Inspector(building, mesh).inspect(); }

}  // namespace plumbline::scenarios
