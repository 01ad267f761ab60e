// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/half_space.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace plumbline::bim {
namespace {

constexpr double margin_m = 1.0;

/// Over a counter-clockwise outline, from low[i] to high[i] along z.
Facets prism(const Eigen::Affine3d& X, const Polygon2& outline, const std::vector<double>& low,
             const std::vector<double>& high) {
  Facets facets;
  const int n = static_cast<int>(outline.size());
  for (const std::vector<double>& z : {low, high})
    for (std::size_t i = 0; i < outline.size(); ++i) facets.points.emplace_back(outline[i].x(), outline[i].y(), z[i]);
  std::vector<int> bottom, top;
  for (int i = 0; i < n; ++i) {
    bottom.push_back(n - 1 - i);
    top.push_back(n + i);
    facets.loops.push_back({i, (i + 1) % n, n + (i + 1) % n, n + i});
  }
  facets.loops.push_back(std::move(bottom));
  facets.loops.push_back(std::move(top));
  return transformed(X, std::move(facets));
}

Facets side_of_plane(const HalfSpace& half_space, const Eigen::AlignedBox3d& around) {
  const Eigen::Vector3d middle = half_space.X_PS.inverse() * around.center();
  const double reach = around.diagonal().norm() + margin_m, depth = reach + std::abs(middle.z());
  const double x = middle.x(), y = middle.y();
  const Polygon2 square = {
      {x - reach, y - reach}, {x + reach, y - reach}, {x + reach, y + reach}, {x - reach, y + reach}};
  const std::vector<double> plane(4, 0.0), end(4, half_space.agreement ? -depth : depth);
  return half_space.agreement ? prism(half_space.X_PS, square, end, plane) : prism(half_space.X_PS, square, plane, end);
}

Polygon2 counter_clockwise(Polygon2 outline) {
  Polygon2 ring;
  for (const Eigen::Vector2d& p : outline)
    if (ring.empty() || (p - ring.back()).norm() > solid_grid_m) ring.push_back(p);
  while (ring.size() > 1 && (ring.front() - ring.back()).norm() <= solid_grid_m) ring.pop_back();
  if (signed_area(ring) < 0.0) std::reverse(ring.begin(), ring.end());
  return ring;
}

}  // namespace

std::optional<Shape> half_space_shape(const HalfSpace& half_space, const Eigen::AlignedBox3d& around) {
  if (!half_space.boundary) return Shape{side_of_plane(half_space, around), {}, {}};
  const Eigen::Affine3d& X_PB = half_space.boundary->X_PB;
  const Polygon2 outline = counter_clockwise(half_space.boundary->outline);
  if (outline.size() < 3 || signed_area(outline) <= solid_grid_m * solid_grid_m) return std::nullopt;
  const Eigen::Affine3d X_BP = X_PB.inverse();
  const double reach = around.diagonal().norm() + margin_m, middle = (X_BP * around.center()).z();
  // The plane n.p = d in the frame of the boundary.
  const Eigen::Affine3d X_BS = X_BP * half_space.X_PS;
  const Eigen::Vector3d n = X_BS.linear().col(2).normalized();
  const double d = n.dot(X_BS.translation());
  constexpr double least_cosine = 1e-3, farthest = 100.0;
  std::vector<double> at_plane;
  for (const Eigen::Vector2d& p : outline)
    at_plane.push_back(std::abs(n.z()) < least_cosine ? 0.0 : (d - n.head<2>().dot(p)) / n.z());
  const auto [least, most] = std::minmax_element(at_plane.begin(), at_plane.end());
  const double low = middle - reach, high = middle + reach;
  if (std::abs(n.z()) < least_cosine || *most - *least > farthest * reach) {
    const std::size_t count = outline.size();
    return Shape{prism(X_PB, outline, std::vector<double>(count, low), std::vector<double>(count, high)),
                 {},
                 {side_of_plane(half_space, around)}};
  }
  const bool below = (n.z() > 0.0) == half_space.agreement;
  const std::vector<double> end(outline.size(),
                                below ? std::min(low, *least - margin_m) : std::max(high, *most + margin_m));
  return Shape{below ? prism(X_PB, outline, end, at_plane) : prism(X_PB, outline, at_plane, end), {}, {}};
}

}  // namespace plumbline::bim
