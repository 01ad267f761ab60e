// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/building_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bim/geometry/polygon.h"

namespace plumbline::slam::ros {

namespace {

constexpr std::int8_t unknown_cell = -1, free_cell = 0, occupied_cell = 100;
constexpr double cut_height_m = 1.2;
constexpr std::uint64_t most_cells = 16'000'000;

std::vector<Triangles> parts_of(const bim::BuildingMesh& mesh) {
  std::vector<Triangles> parts = {{"walls", {0.80F, 0.78F, 0.72F, 1.0F}, {}},
                                  {"slabs", {0.55F, 0.55F, 0.55F, 1.0F}, {}},
                                  {"columns", {0.65F, 0.60F, 0.55F, 1.0F}, {}},
                                  {"stairs", {0.60F, 0.62F, 0.66F, 1.0F}, {}},
                                  {"furniture", {0.62F, 0.47F, 0.33F, 1.0F}, {}}};
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const bim::MeshElement& element = mesh.elements[static_cast<std::size_t>(mesh.element[i])];
    for (const int corner : mesh.triangles[i])
      parts[static_cast<std::size_t>(element.kind)].corners.push_back(mesh.vertices[static_cast<std::size_t>(corner)]);
  }
  std::erase_if(parts, [](const Triangles& part) { return part.corners.empty(); });
  return parts;
}

/// A grid around the rooms of a storey, all unknown; without cells where there are none, or too many.
Grid empty_grid(const bim::Plan& plan, int storey) {
  Grid grid;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const bim::PlanRoom& room : plan.rooms)
    for (const Eigen::Vector2d& p : room.polygon) {
      if (room.storey != storey) continue;
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  if (!(low.x() <= high.x())) return grid;
  constexpr double margin_m = 0.5;
  grid.frame = "map";
  const double size = static_cast<double>(grid.resolution_m);
  const Eigen::Vector2d first = ((low.array() - margin_m) / size).floor(),
                        last = ((high.array() + margin_m) / size).ceil();
  const Eigen::Vector2d cells = last - first;
  if (cells.x() * cells.y() > static_cast<double>(most_cells)) return grid;
  grid.width = static_cast<std::uint32_t>(cells.x());
  grid.height = static_cast<std::uint32_t>(cells.y());
  grid.origin = {first.x() * size, first.y() * size, plan.storeys[static_cast<std::size_t>(storey)].elevation_m};
  grid.cells.assign(std::size_t{grid.width} * grid.height, unknown_cell);
  return grid;
}

void free_rooms(const bim::Plan& plan, int storey, Grid& grid) {
  const double size = static_cast<double>(grid.resolution_m);
  for (const bim::PlanRoom& room : plan.rooms) {
    if (room.storey != storey || room.polygon.empty()) continue;
    Eigen::Vector2d low = room.polygon.front(), high = low;
    for (const Eigen::Vector2d& p : room.polygon) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const auto cell = [&](double value, double origin) {  // the grid reaches beyond every room
      return static_cast<std::uint32_t>((value - origin) / size);
    };
    for (std::uint32_t row = cell(low.y(), grid.origin.y()); row <= cell(high.y(), grid.origin.y()); ++row)
      for (std::uint32_t column = cell(low.x(), grid.origin.x()); column <= cell(high.x(), grid.origin.x()); ++column) {
        const Eigen::Vector2d centre(grid.origin.x() + (column + 0.5) * size, grid.origin.y() + (row + 0.5) * size);
        if (contains(room.polygon, centre)) grid.cells[std::size_t{row} * grid.width + column] = free_cell;
      }
  }
}

/// Where a triangle crosses the height z: none or two points.
std::vector<Eigen::Vector2d> crossing(const std::array<Eigen::Vector3d, 3>& corners, double z) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d &a = corners[i], &b = corners[(i + 1) % 3];
    if ((a.z() >= z) == (b.z() >= z)) continue;
    const double share = (z - a.z()) / (b.z() - a.z());
    points.emplace_back(a.head<2>() + share * (b.head<2>() - a.head<2>()));
  }
  return points;
}

void occupy(const Eigen::Vector2d& a, const Eigen::Vector2d& b, Grid& grid) {
  const double size = static_cast<double>(grid.resolution_m);
  const auto steps = static_cast<int>(std::ceil((b - a).norm() / (0.2 * size))) + 1;
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d cell = ((a + (b - a) * (1.0 * i / steps) - grid.origin.head<2>()) / size).array().floor();
    if (cell.x() < 0.0 || cell.y() < 0.0 || cell.x() >= grid.width || cell.y() >= grid.height) continue;
    grid.cells[static_cast<std::size_t>(cell.y()) * grid.width + static_cast<std::size_t>(cell.x())] = occupied_cell;
  }
}

}  // namespace

BuildingView building_view(const bim::BuildingMesh& mesh, const bim::Plan& plan, int storey) {
  BuildingView view{parts_of(mesh), {}};
  if (storey < 0 || static_cast<std::size_t>(storey) >= plan.storeys.size()) return view;
  view.plan = empty_grid(plan, storey);
  if (view.plan.cells.empty()) return view;
  free_rooms(plan, storey, view.plan);
  const double z = view.plan.origin.z() + cut_height_m;
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    std::array<Eigen::Vector3d, 3> corners;
    for (int i = 0; i < 3; ++i)
      corners[static_cast<std::size_t>(i)] = mesh.vertices[static_cast<std::size_t>(triangle[i])];
    const std::vector<Eigen::Vector2d> points = crossing(corners, z);
    if (points.size() == 2) occupy(points[0], points[1], view.plan);
  }
  return view;
}

}  // namespace plumbline::slam::ros
