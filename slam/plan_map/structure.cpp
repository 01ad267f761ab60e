// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/structure.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace plumbline::slam {

namespace {

constexpr std::size_t batch = 16;          // rays cast in one call; a call of few clears as many
constexpr double upright_max_slope = 0.5;  // of a normal

/// Boxes around the parts of an element that hang together by their vertices.
std::map<int, Eigen::AlignedBox3d> parts_of(const bim::BuildingMesh& mesh, const bim::MeshElement& element) {
  std::map<int, int> parent;  // of each vertex
  const auto root = [&](int vertex) {
    while (parent.try_emplace(vertex, vertex).first->second != vertex) vertex = parent[vertex] = parent[parent[vertex]];
    return vertex;
  };
  const auto triangles =
      std::span(mesh.triangles)
          .subspan(static_cast<std::size_t>(element.first_triangle), static_cast<std::size_t>(element.triangle_count));
  for (const Eigen::Vector3i& triangle : triangles)
    for (const int vertex : {triangle.y(), triangle.z()}) parent[root(vertex)] = root(triangle.x());
  std::map<int, Eigen::AlignedBox3d> parts;
  for (const Eigen::Vector3i& triangle : triangles)
    for (const int vertex : triangle) parts[root(vertex)].extend(mesh.vertices[static_cast<std::size_t>(vertex)]);
  return parts;
}

bool has_bars(const bim::BuildingMesh& mesh, const bim::MeshElement& element) {
  // Balusters are 1 to 6 cm thick and 0.7 m high or more.
  constexpr double thickness_max_m = 0.15, height_min_m = 0.3;
  constexpr std::ptrdiff_t bars_min = 3;
  if (element.kind != bim::ElementKind::obstacle) return false;
  const std::map<int, Eigen::AlignedBox3d> parts = parts_of(mesh, element);
  return std::count_if(parts.begin(), parts.end(), [&](const auto& part) {
           const Eigen::Vector3d size = part.second.sizes();
           return size.head<2>().norm() <= thickness_max_m && size.z() >= height_min_m;
         }) >= bars_min;
}

}  // namespace

Structure::Structure(const bim::BuildingMesh& mesh_I) : scene_(mesh_I) {
  for (const bim::MeshElement& element : mesh_I.elements) {
    wall_.push_back(element.kind == bim::ElementKind::wall);
    blocks_.push_back(wall_.back() || element.kind == bim::ElementKind::column);
    railing_.push_back(has_bars(mesh_I, element));
  }
}

void Structure::cast(const Eigen::Vector3d& origin_I, std::span<const SensorRay> rays, double range_max_m,
                     std::span<StructureHit> hits) const {
  std::array<bim::Ray, batch> rays_W;
  std::array<bim::Hit, batch> hits_W;
  std::array<double, batch> level;
  for (std::size_t first = 0; first < rays.size(); first += batch) {
    const std::size_t count = std::min(batch, rays.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      const SensorRay& ray = rays[first + i];
      level[i] = 1.0 / std::sqrt(1.0 + ray.slope * ray.slope);
      rays_W[i] = {origin_I, {level[i] * ray.direction.x(), level[i] * ray.direction.y(), level[i] * ray.slope}, 0.0};
    }
    scene_.cast(std::span(rays_W).first(count), range_max_m, std::span(hits_W).first(count));
    for (std::size_t i = 0; i < count; ++i) {
      const bim::Hit& found = hits_W[i];
      StructureHit& hit = hits[first + i];
      hit = {};
      if (found.element < 0) continue;
      hit.distance = found.range_m * level[i];
      hit.element = found.element;
      const Eigen::Vector2d n = found.normal_W.head<2>();
      const double length = n.norm();
      hit.upright = std::abs(found.normal_W.z()) < upright_max_slope * length;
      if (hit.upright) hit.n = n / length;
    }
  }
}

int Structure::barrier(const Eigen::Vector3d& from_I, const Eigen::Vector3d& to_I) const {
  const double length = (to_I - from_I).norm();
  if (length < 1e-6) return -1;
  const bim::Hit hit = scene_.cast({from_I, (to_I - from_I) / length, 0.0}, length);
  return hit.element >= 0 && blocks_[static_cast<std::size_t>(hit.element)] ? hit.element : -1;
}

std::optional<double> Structure::ground_below(const Eigen::Vector3d& p_I, double reach_m) const {
  const bim::Hit hit = scene_.cast({p_I, -Eigen::Vector3d::UnitZ(), 0.0}, reach_m);
  if (hit.element < 0) return std::nullopt;
  return p_I.z() - hit.range_m;
}

}  // namespace plumbline::slam
