// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "bim/errors.h"
#include "scenarios/metrics/extent.h"
#include "scenarios/metrics/map_score.h"

namespace plumbline::scenarios::score {

namespace {

struct Triangle {
  Eigen::Vector3d a, b, c;
};

double edge_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double s = length2 > 0.0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (a + s * ab - p).norm();
}

}  // namespace

double triangle_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                         const Eigen::Vector3d& c) {
  const Eigen::Vector3d n = (b - a).cross(c - a);
  const double area2 = n.norm();
  const bool above = area2 > 0.0 && (b - a).cross(p - a).dot(n) >= 0.0 && (c - b).cross(p - b).dot(n) >= 0.0 &&
                     (a - c).cross(p - c).dot(n) >= 0.0;
  if (above) return std::abs((p - a).dot(n)) / area2;
  return std::min({edge_distance(p, a, b), edge_distance(p, b, c), edge_distance(p, c, a)});
}

/// Triangles by cell, as one array with offsets.
struct SurfaceDistance::Grid {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  double size = 0.5;
  std::array<int, 3> count{};
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> offset;
  std::vector<std::uint32_t> entry;

  [[nodiscard]] int coordinate(double x, Eigen::Index axis) const {
    const double cell = std::floor((x - origin[axis]) / size);
    const auto cells = static_cast<double>(count[static_cast<std::size_t>(axis)]);
    return static_cast<int>(std::clamp(cell, -2.0, cells + 1.0));  // outside points keep their neighbourhood empty
  }
  [[nodiscard]] std::size_t index(int x, int y, int z) const {
    const auto nx = static_cast<std::size_t>(count[0]);
    const auto ny = static_cast<std::size_t>(count[1]);
    return (static_cast<std::size_t>(z) * ny + static_cast<std::size_t>(y)) * nx + static_cast<std::size_t>(x);
  }
  [[nodiscard]] double cell_distance(const Eigen::Vector3d& p, int x, int y, int z) const {
    const Eigen::Vector3d low = origin + size * Eigen::Vector3d(x, y, z);
    const Eigen::Vector3d high = low + Eigen::Vector3d::Constant(size);
    return (p - p.cwiseMax(low).cwiseMin(high)).norm();
  }

  /// Calls visit(cell) for every cell that the triangle's box and plane both reach.
  template <class Visit>
  void for_cells(const Triangle& t, const Visit& visit) const {
    const Eigen::Vector3d low = t.a.cwiseMin(t.b).cwiseMin(t.c);
    const Eigen::Vector3d high = t.a.cwiseMax(t.b).cwiseMax(t.c);
    const Eigen::Vector3d n = (t.b - t.a).cross(t.c - t.a);
    const double reach = 0.5 * size * n.cwiseAbs().sum() * (1.0 + 1e-9);
    for (int z = coordinate(low.z(), 2); z <= coordinate(high.z(), 2); ++z)
      for (int y = coordinate(low.y(), 1); y <= coordinate(high.y(), 1); ++y)
        for (int x = coordinate(low.x(), 0); x <= coordinate(high.x(), 0); ++x) {
          const Eigen::Vector3d center = origin + size * (Eigen::Vector3d(x, y, z) + Eigen::Vector3d::Constant(0.5));
          if (std::abs((center - t.a).dot(n)) <= reach) visit(index(x, y, z));
        }
  }

  void fill() {
    offset.assign(index(0, 0, count[2]) + 1, 0);
    for (const Triangle& t : triangles) for_cells(t, [&](std::size_t cell) { ++offset[cell + 1]; });
    std::partial_sum(offset.begin(), offset.end(), offset.begin());
    entry.resize(offset.back());
    std::vector<std::uint32_t> next(offset.begin(), std::prev(offset.end()));
    for (std::uint32_t i = 0; i < triangles.size(); ++i)
      for_cells(triangles[i], [&](std::size_t cell) { entry[next[cell]++] = i; });
  }

  /// Lowers best to the distance of the nearest triangle of one cell.
  void visit_cell(const Eigen::Vector3d& p, int x, int y, int z, double& best) const {
    if (x < 0 || y < 0 || z < 0 || x >= count[0] || y >= count[1] || z >= count[2]) return;
    if (cell_distance(p, x, y, z) >= best) return;
    const std::size_t cell = index(x, y, z);
    for (std::uint32_t i = offset[cell]; i < offset[cell + 1]; ++i) {
      const Triangle& t = triangles[entry[i]];
      best = std::min(best, triangle_distance(p, t.a, t.b, t.c));
    }
  }
};

SurfaceDistance::SurfaceDistance(const bim::BuildingMesh& mesh, double cap_m) {
  if (mesh.triangles.empty()) throw InternalError("score: the as-built mesh is empty");
  check_extent(mesh);
  Grid grid;
  grid.size = cap_m;
  const auto vertex = [&](int i) { return mesh.vertices[static_cast<std::size_t>(i)]; };
  Eigen::Vector3d low = vertex(mesh.triangles.front()[0]);
  Eigen::Vector3d high = low;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Triangle triangle{vertex(t[0]), vertex(t[1]), vertex(t[2])};
    low = low.cwiseMin(triangle.a).cwiseMin(triangle.b).cwiseMin(triangle.c);
    high = high.cwiseMax(triangle.a).cwiseMax(triangle.b).cwiseMax(triangle.c);
    grid.triangles.push_back(triangle);
  }
  grid.origin = low;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    grid.count[k] = 1 + static_cast<int>(std::floor((high[axis] - low[axis]) / cap_m));
  }
  grid.fill();
  grid_ = std::make_unique<const Grid>(std::move(grid));
}

SurfaceDistance::~SurfaceDistance() = default;
SurfaceDistance::SurfaceDistance(SurfaceDistance&&) noexcept = default;
SurfaceDistance& SurfaceDistance::operator=(SurfaceDistance&&) noexcept = default;

double SurfaceDistance::operator()(const Eigen::Vector3d& p_W) const {
  const int x = grid_->coordinate(p_W.x(), 0);
  const int y = grid_->coordinate(p_W.y(), 1);
  const int z = grid_->coordinate(p_W.z(), 2);
  double best = grid_->size;
  grid_->visit_cell(p_W, x, y, z, best);
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) grid_->visit_cell(p_W, x + dx, y + dy, z + dz, best);
  return best;
}

std::vector<NearTriangle> SurfaceDistance::near(const Eigen::Vector3d& p_W, double reach_m) const {
  const Grid& grid = *grid_;
  std::vector<NearTriangle> near;
  const auto cells = [&](Eigen::Index axis) {
    return std::pair(
        std::max(0, grid.coordinate(p_W[axis] - reach_m, axis)),
        std::min(grid.count[static_cast<std::size_t>(axis)] - 1, grid.coordinate(p_W[axis] + reach_m, axis)));
  };
  const auto [x0, x1] = cells(0);
  const auto [y0, y1] = cells(1);
  const auto [z0, z1] = cells(2);
  for (int z = z0; z <= z1; ++z)
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const std::size_t cell = grid.index(x, y, z);
        for (std::uint32_t i = grid.offset[cell]; i < grid.offset[cell + 1]; ++i) {
          const Triangle& t = grid.triangles[grid.entry[i]];
          const double distance_m = triangle_distance(p_W, t.a, t.b, t.c);
          if (distance_m <= reach_m) near.push_back({static_cast<int>(grid.entry[i]), distance_m});
        }
      }
  return near;
}

}  // namespace plumbline::scenarios::score
