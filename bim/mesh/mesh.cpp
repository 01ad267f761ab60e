// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/mesh.h"

#include <algorithm>
#include <array>
#include <utility>

#include "bim/mesh/exact_boolean.h"
#include "bim/mesh/shells.h"
#include "bim/mesh/solid.h"
#include "bim/model/extrude.h"

namespace plumbline::bim {

namespace {

/// Every edge is run through as often one way as the other, as in closed parts that touch.
bool edges_cancel(const Solid& solid) {
  std::vector<std::array<int, 3>> runs;
  for (const Eigen::Vector3i& t : solid.triangles)
    for (int k = 0; k < 3; ++k) {
      const int from = t[k], to = t[(k + 1) % 3];
      runs.push_back({std::min(from, to), std::max(from, to), from < to ? 1 : -1});
    }
  std::sort(runs.begin(), runs.end());
  for (std::size_t i = 0; i < runs.size();) {
    int sum = 0;
    const std::size_t first = i;
    for (; i < runs.size() && runs[i][0] == runs[first][0] && runs[i][1] == runs[first][1]; ++i) sum += runs[i][2];
    if (sum != 0) return false;
  }
  return true;
}

/// A body as it came: welded where its triangles were not joined, taken apart again where that makes parts touch, and
/// outward where it closes.
CutWall taken_over(const std::string& id, const Solid& body, const MeshConfig& config) {
  Solid solid = is_closed(body) ? body : welded(body, config.weld_m);
  if (!is_closed(solid) && edges_cancel(solid))
    if (Solid apart = touching_parts_separated(solid); is_closed(apart)) solid = std::move(apart);
  const bool closed = is_closed(solid);
  if (closed) solid = shells_turned_outward(solid);
  CutWall result{canonical(solid, config.grid_m), closed, {}};
  if (!closed) result.warnings.push_back({id, "not_closed", "the body's surface does not close"});
  return result;
}

CutWall swept(const Region2& region, double z0_m, double z1_m, const MeshConfig& config) {
  return {canonical(extrude(region, z0_m, z1_m), config.grid_m), true, {}};
}

CutWall slab_solid(const Slab& slab, const MeshConfig& config) {
  if (slab.body) return taken_over(slab.id, *slab.body, config);
  return swept(subtract(unite(std::vector<Polygon2>{slab.polygon.outer}), slab.polygon.holes), slab.z0_m, slab.z1_m,
               config);
}

CutWall column_solid(const Column& column, const MeshConfig& config) {
  if (column.body) return taken_over(column.id, *column.body, config);
  return swept(unite(std::vector<Polygon2>{column.footprint}), column.z0_m, column.z1_m, config);
}

/// All bodies of a stair as one element; it closes when each of them does.
CutWall stair_solid(const Stair& stair, const MeshConfig& config) {
  CutWall whole{{}, true, {}};
  for (const Solid& body : stair.bodies) {
    const CutWall part = taken_over(stair.id, body, config);
    const int first = static_cast<int>(whole.solid.vertices.size());
    whole.solid.vertices.insert(whole.solid.vertices.end(), part.solid.vertices.begin(), part.solid.vertices.end());
    for (const Eigen::Vector3i& t : part.solid.triangles) whole.solid.triangles.push_back(t.array() + first);
    whole.closed = whole.closed && part.closed;
    whole.warnings.insert(whole.warnings.end(), part.warnings.begin(), part.warnings.end());
  }
  return whole;
}

/// Appends elements in the order of the calls.
class Assembly {
 public:
  void add(ElementKind kind, int index, const std::string& id, int storey, CutWall part) {
    MeshElement element{id, kind, index, storey, part.closed};
    element.volume_m3 = part.closed ? volume(part.solid) : 0.0;
    element.first_triangle = static_cast<int>(mesh_.triangles.size());
    element.triangle_count = static_cast<int>(part.solid.triangles.size());
    const int first_vertex = static_cast<int>(mesh_.vertices.size());
    const int number = static_cast<int>(mesh_.elements.size());
    mesh_.vertices.insert(mesh_.vertices.end(), part.solid.vertices.begin(), part.solid.vertices.end());
    for (const Eigen::Vector3i& t : part.solid.triangles) {
      mesh_.triangles.push_back(t.array() + first_vertex);
      mesh_.element.push_back(number);
    }
    mesh_.elements.push_back(std::move(element));
    mesh_.warnings.insert(mesh_.warnings.end(), part.warnings.begin(), part.warnings.end());
  }

  [[nodiscard]] BuildingMesh take() { return std::move(mesh_); }

 private:
  BuildingMesh mesh_;
};

std::vector<std::vector<Opening>> openings_by_wall(const Building& building) {
  std::vector<std::vector<Opening>> by_wall(building.walls.size());
  for (const Opening& opening : building.openings)
    if (opening.wall >= 0) by_wall[static_cast<std::size_t>(opening.wall)].push_back(opening);
  return by_wall;
}

}  // namespace

BuildingMesh build_mesh(const Building& building, const MeshConfig& config) {
  const auto openings = openings_by_wall(building);
  Assembly assembly;
  int index = 0;
  for (const Wall& wall : building.walls) {
    const std::vector<Opening>& own = openings[static_cast<std::size_t>(index)];
    assembly.add(ElementKind::wall, index++, wall.id, wall.storey, cut_wall(wall, own, config));
  }
  index = 0;
  for (const Slab& slab : building.slabs)
    assembly.add(ElementKind::slab, index++, slab.id, slab.storey, slab_solid(slab, config));
  index = 0;
  for (const Column& column : building.columns)
    assembly.add(ElementKind::column, index++, column.id, column.storey, column_solid(column, config));
  index = 0;
  for (const Stair& stair : building.stairs)
    assembly.add(ElementKind::stair, index++, stair.id, stair.from, stair_solid(stair, config));
  index = 0;
  for (const Obstacle& obstacle : building.obstacles)
    assembly.add(ElementKind::obstacle, index++, obstacle.id, obstacle.storey,
                 taken_over(obstacle.id, obstacle.body, config));
  return assembly.take();
}

}  // namespace plumbline::bim
