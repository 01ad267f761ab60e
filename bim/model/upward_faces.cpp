// SPDX-License-Identifier: Apache-2.0
#include "bim/model/upward_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>

#include "bim/geometry/polygon_boolean.h"

namespace plumbline::bim {
namespace {

using Cell3 = std::array<std::int64_t, 3>;

std::int64_t cell_of(double v, double grid) { return static_cast<std::int64_t>(std::llround(v / grid)); }

/// A triangle that looks up.
struct UpwardTriangle {
  std::array<Eigen::Vector3d, 3> corners;
  Eigen::Vector3d normal;  ///< twice its area long

  [[nodiscard]] double plan_m2() const { return 0.5 * normal.z(); }
  [[nodiscard]] Eigen::Vector3d middle() const { return (corners[0] + corners[1] + corners[2]) / 3.0; }
};

std::vector<UpwardTriangle> upward_triangles(const Solid& body, const UpwardFaceConfig& config) {
  std::vector<UpwardTriangle> found;
  for (const Eigen::Vector3i& t : body.triangles) {
    const auto p = [&](int k) -> const Eigen::Vector3d& { return body.vertices[static_cast<std::size_t>(t[k])]; };
    const Eigen::Vector3d n = (p(1) - p(0)).cross(p(2) - p(0));
    if (!(n.z() > 0.0) || n.head<2>().norm() > config.steepest * n.z()) continue;
    found.push_back({{p(0), p(1), p(2)}, n});
  }
  return found;
}

/// Where a plane with this normal through a point lies; level where it is nearly so.
UpwardFace face_through(const Eigen::Vector3d& p, const Eigen::Vector3d& normal, const UpwardFaceConfig& config) {
  UpwardFace face;
  face.slope = -normal.head<2>() / normal.z();
  if (face.slope.norm() <= config.level) face.slope.setZero();
  face.z0_m = p.z() - face.slope.dot(p.head<2>());
  face.top_m = p.z();
  return face;
}

Polygon2 plan_outline(const UpwardTriangle& triangle) {
  Polygon2 corners;
  for (const Eigen::Vector3d& p : triangle.corners) corners.push_back(p.head<2>());
  return corners;
}

void put_into_face(const UpwardTriangle& triangle, UpwardFace& face) {
  face.triangles.push_back(plan_outline(triangle));
  for (const Eigen::Vector3d& p : triangle.corners) face.top_m = std::max(face.top_m, p.z());
}

/// Which triangles hang together over edges.
class Connection {
 public:
  explicit Connection(std::size_t count) : root_(count) { std::iota(root_.begin(), root_.end(), std::size_t{0}); }

  void join(std::size_t i, std::size_t j) {
    const std::size_t one = first(i), other = first(j);
    root_[std::max(one, other)] = std::min(one, other);
  }
  /// The first of those that one hangs together with.
  std::size_t first(std::size_t i) {
    while (root_[i] != i) i = root_[i] = root_[root_[i]];
    return i;
  }
  std::vector<std::size_t> firsts() {
    std::vector<std::size_t> all;
    for (std::size_t i = 0; i < root_.size(); ++i) all.push_back(first(i));
    return all;
  }

 private:
  std::vector<std::size_t> root_;
};

struct Connections {
  std::vector<std::size_t> surface;  ///< for each triangle the first of those that it hangs together with
  std::vector<std::size_t> flat;     ///< ... of those in its plane
};

Connections connections_of(const std::vector<UpwardTriangle>& triangles, const std::vector<Cell3>& planes) {
  constexpr double grid_m = 1e-4;
  Connection surface(triangles.size()), flat(triangles.size());
  std::map<std::pair<Cell3, Cell3>, std::size_t> edges;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto corner = [&](std::size_t c) -> Cell3 {
        const Eigen::Vector3d& p = triangles[i].corners[c % 3];
        return {cell_of(p.x(), grid_m), cell_of(p.y(), grid_m), cell_of(p.z(), grid_m)};
      };
      const auto [edge, fresh] = edges.emplace(std::minmax(corner(k), corner(k + 1)), i);
      if (fresh) continue;
      surface.join(i, edge->second);
      if (planes[i] == planes[edge->second]) flat.join(i, edge->second);
    }
  return {surface.firsts(), flat.firsts()};
}

/// Triangles that with their neighbours in one plane have less than an area. Neighbours may only touch, without an edge
/// in common.
std::vector<bool> small_ones(const std::vector<UpwardTriangle>& triangles, const std::vector<Cell3>& planes,
                             const std::vector<std::size_t>& flat, double least_m2) {
  std::vector<double> flat_m2(triangles.size(), 0.0);
  std::map<Cell3, double> plane_m2;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    flat_m2[flat[i]] += triangles[i].plan_m2();
    plane_m2[planes[i]] += triangles[i].plan_m2();
  }
  std::vector<bool> small(triangles.size(), false);
  std::map<Cell3, std::vector<Polygon2>> unsure;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    small[i] = flat_m2[flat[i]] < least_m2;
    if (small[i] && plane_m2[planes[i]] >= least_m2) unsure[planes[i]] = {};
  }
  for (std::size_t i = 0; i < triangles.size(); ++i)
    if (const auto plane = unsure.find(planes[i]); plane != unsure.end())
      plane->second.push_back(plan_outline(triangles[i]));
  std::map<Cell3, Region2> large;
  for (const auto& [plane, outlines] : unsure) {
    Region2& pieces = large[plane] = unite(outlines);
    std::erase_if(pieces, [&](const PolygonWithHoles2& piece) { return area({piece}) < least_m2; });
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (!small[i]) continue;
    const Eigen::Vector2d middle = triangles[i].middle().head<2>();
    const auto in = [&](const PolygonWithHoles2& piece) { return contains(piece, middle); };
    const auto plane = large.find(planes[i]);
    if (plane != large.end()) small[i] = std::none_of(plane->second.begin(), plane->second.end(), in);
  }
  return small;
}

/// One plane for the small ones of a connected surface within each cell of the plan.
std::vector<UpwardFace> patches_of(const std::vector<UpwardTriangle>& triangles, const std::vector<std::size_t>& root,
                                   const std::vector<bool>& joined, const UpwardFaceConfig& config) {
  std::map<Cell3, std::vector<std::size_t>> cells;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (!joined[i]) continue;
    const Eigen::Vector3d middle = triangles[i].middle();
    cells[{static_cast<std::int64_t>(root[i]), cell_of(middle.x(), config.patch_m),
           cell_of(middle.y(), config.patch_m)}]
        .push_back(i);
  }
  std::vector<UpwardFace> patches;
  for (const auto& [cell, members] : cells) {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero(), middle = Eigen::Vector3d::Zero();
    double plan_m2 = 0.0;
    for (const std::size_t i : members) {
      normal += triangles[i].normal;
      middle += triangles[i].plan_m2() * triangles[i].middle();
      plan_m2 += triangles[i].plan_m2();
    }
    UpwardFace& patch = patches.emplace_back(face_through(middle / plan_m2, normal, config));
    for (const std::size_t i : members) put_into_face(triangles[i], patch);
  }
  return patches;
}

}  // namespace

std::vector<UpwardFace> upward_faces(const Solid& body, const UpwardFaceConfig& config) {
  constexpr double grid = 2e-3;
  const std::vector<UpwardTriangle> triangles = upward_triangles(body, config);
  std::vector<Cell3> keys;
  for (const UpwardTriangle& triangle : triangles) {
    const UpwardFace plane = face_through(triangle.middle(), triangle.normal, config);
    keys.push_back({cell_of(plane.slope.x(), grid), cell_of(plane.slope.y(), grid), cell_of(plane.z0_m, grid)});
  }
  const Connections connections = connections_of(triangles, keys);
  const std::vector<std::size_t>& root = connections.surface;
  std::vector<bool> joined = small_ones(triangles, keys, connections.flat, config.least_m2);
  std::vector<double> surface_m2(triangles.size(), 0.0), small_m2(triangles.size(), 0.0);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    surface_m2[root[i]] += triangles[i].plan_m2();
    if (joined[i]) small_m2[root[i]] += triangles[i].plan_m2();
  }
  std::map<Cell3, UpwardFace> planes;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const double small = small_m2[root[i]];
    joined[i] = joined[i] && small >= config.least_m2 && small >= config.uneven_share * surface_m2[root[i]];
    if (joined[i]) continue;
    UpwardFace& face = planes[keys[i]];
    if (face.triangles.empty()) face = face_through(triangles[i].middle(), triangles[i].normal, config);
    put_into_face(triangles[i], face);
  }
  std::vector<UpwardFace> faces;
  for (auto& [key, face] : planes) faces.push_back(std::move(face));
  for (UpwardFace& patch : patches_of(triangles, root, joined, config)) faces.push_back(std::move(patch));
  return faces;
}

}  // namespace plumbline::bim
