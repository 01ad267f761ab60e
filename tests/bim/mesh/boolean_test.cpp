// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/boolean.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "bim/mesh/membrane.h"
#include "bim/mesh/solid.h"

namespace plumbline::bim {
namespace {

constexpr double grid_m = 1e-5;

/// Over a convex counter-clockwise outline in the plane of the axes u and v, from low to high along the third.
Solid prism(const std::vector<Eigen::Vector2d>& outline, Eigen::Index u, Eigen::Index v, double low, double high) {
  const Eigen::Index w = 3 - u - v;
  const int n = static_cast<int>(outline.size());
  Solid solid;
  for (const double level : {low, high}) {
    for (const Eigen::Vector2d& at : outline) {
      Eigen::Vector3d p;
      p[u] = at.x();
      p[v] = at.y();
      p[w] = level;
      solid.vertices.push_back(p);
    }
  }
  for (int i = 0; i < n; ++i) {
    const int next = (i + 1) % n;
    solid.triangles.emplace_back(i, next, n + next);
    solid.triangles.emplace_back(i, n + next, n + i);
    if (i == 0 || next == 0) continue;
    solid.triangles.emplace_back(0, next, i);
    solid.triangles.emplace_back(n, n + i, n + next);
  }
  return turned_outward(solid);
}

Solid box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return prism({{low.x(), low.y()}, {high.x(), low.y()}, {high.x(), high.y()}, {low.x(), high.y()}}, 0, 1, low.z(),
               high.z());
}

BooleanResult less(const Solid& body, const std::vector<Solid>& cutters) {
  std::vector<BooleanStep> steps;
  for (const Solid& cutter : cutters) steps.push_back({BooleanOperation::difference, cutter});
  return boolean_steps(body, steps, grid_m);
}

/// Where a line along x meets the surface, ascending.
std::vector<double> crossings(const Solid& solid, double y, double z) {
  std::vector<double> at;
  for (const Eigen::Vector3i& t : solid.triangles) {
    const auto p = [&](int k) -> const Eigen::Vector3d& { return solid.vertices[static_cast<std::size_t>(t[k])]; };
    const Eigen::Vector3d e = p(1) - p(0), f = p(2) - p(0);
    const double det = e.y() * f.z() - e.z() * f.y(), dy = y - p(0).y(), dz = z - p(0).z();
    if (det == 0.0) continue;
    const double a = (dy * f.z() - dz * f.y()) / det, b = (e.y() * dz - e.z() * dy) / det;
    if (a >= 0.0 && b >= 0.0 && a + b <= 1.0) at.push_back(p(0).x() + a * e.x() + b * f.x());
  }
  std::sort(at.begin(), at.end());
  return at;
}

/// What a cut leaves where it runs out of a wall's face at a small angle is a wedge that begins with no thickness.
TEST(BooleanSteps, CloseWhereACutRunsAlmostAlongAFace) {
  const double length = 6.52379, x0 = 0.99977, half = 0.25, height = 1.4, z0 = 0.3, z1 = 0.8;
  const Solid wall = box({0, -half, 0}, {length, half, height});
  for (const double tilt : {0.0, 1e-7, 1e-6, 5e-6, 1e-5, 3e-5, 7.2e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2}) {
    const double far = x0 + 10.0, sine = std::sin(tilt), cosine = std::cos(tilt);
    const Eigen::Vector2d along(cosine, -sine), across(sine, cosine), corner(x0, -half);
    const Solid slot = prism({corner, corner + (far - x0) * along, corner + (far - x0) * along + 2.0 * half * across,
                              corner + 2.0 * half * across},
                             0, 1, z0, z1);
    const BooleanResult rest = less(wall, {slot});
    EXPECT_TRUE(rest.closed) << tilt;
    EXPECT_TRUE(is_closed(rest.solid)) << tilt;
    const double deep = length - x0, wedge = 0.5 * deep * deep * std::tan(tilt);
    const double expected = 2.0 * half * length * height - (2.0 * half * deep - wedge) * (z1 - z0);
    EXPECT_NEAR(volume(rest.solid), expected, 8.5 * 4.0 * grid_m + 0.13 * tilt)
        << tilt;  // the faces in the slot: 8.5 m2
    // It stays whole under the cuts that follow.
    const BooleanResult next = less(rest.solid, {box({3, -1, 1}, {3.5, 1, 1.2})});
    EXPECT_TRUE(next.closed) << tilt;
    EXPECT_NEAR(volume(next.solid), volume(rest.solid) - 0.5 * 0.5 * 0.2, 1e-5) << tilt;
  }
}

/// Rounding puts an edge of the opening beside the plane that ends the wall there.
TEST(BooleanSteps, LeaveNoMembraneWhereACutEndsOnAFace) {
  for (const double off : {-1e-5, 0.0, 1e-5, 2e-5}) {
    const Solid wall = prism({{0, 2.6464}, {15.27396, 2.6464}, {15.27396, 12.1781}, {14.96196, 17.691}, {0, 17.691}}, 0,
                             2, -0.17297, 0.17303);
    const Solid opening =
        prism({{14.96196, 14.696}, {15.13146 + off, 14.696}, {14.96196 + off, 17.691}}, 0, 2, -0.2, 0.2);
    const BooleanResult rest = less(wall, {opening});
    EXPECT_TRUE(rest.closed) << off;
    EXPECT_FALSE(has_membrane(rest.solid, grid_m)) << off;
    for (const double z : {14.8, 15.5, 16.0, 17.0, 17.6}) {
      const std::vector<double> at = crossings(rest.solid, 0.0507, z);
      ASSERT_FALSE(at.empty());
      EXPECT_NEAR(at.back(), 14.96196, 6.0 * grid_m) << off << " " << z;
    }
  }
}

TEST(HasMembrane, KnowsSkinsFromThinParts) {
  const Solid thick = box({0, 0, 0}, {1, 1, 10.0 * grid_m});
  EXPECT_FALSE(has_membrane(thick, grid_m));
  EXPECT_TRUE(has_membrane(box({0, 0, 0}, {1, 1, 0.5 * grid_m}), grid_m));
  Solid pillow = box({0, 0, 0}, {1, 1, 0});
  EXPECT_TRUE(has_membrane(pillow, grid_m));
  Solid stacked = box({0, 0, 0}, {1, 1, 1});
  const Solid upper = box({0.2, 0.2, 1}, {0.7, 0.7, 2});
  for (const Eigen::Vector3i& t : upper.triangles)
    stacked.triangles.push_back(t.array() + static_cast<int>(stacked.vertices.size()));
  stacked.vertices.insert(stacked.vertices.end(), upper.vertices.begin(), upper.vertices.end());
  EXPECT_TRUE(has_membrane(stacked, grid_m));
  EXPECT_FALSE(has_membrane({}, grid_m));
}

}  // namespace
}  // namespace plumbline::bim
