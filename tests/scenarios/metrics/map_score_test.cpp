// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/map_score.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bim/errors.h"
#include "bim/random/stream.h"

namespace plumbline::scenarios::score {
namespace {

Eigen::Vector3d random_point(const Stream& stream, std::uint64_t tick, std::uint32_t lane, double size) {
  return {size * stream.uniform(tick, lane, 0), size * stream.uniform(tick, lane, 1),
          size * stream.uniform(tick, lane, 2)};
}

/// A soup of `count` random triangles in a box of 6 m.
bim::BuildingMesh random_mesh(const Stream& stream, std::uint64_t tick, int count) {
  bim::BuildingMesh mesh;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d a = random_point(stream, tick, static_cast<std::uint32_t>(4 * i), 6.0);
    for (std::uint32_t k = 0; k < 3; ++k)
      mesh.vertices.push_back(a + random_point(stream, tick, static_cast<std::uint32_t>(4 * i) + k + 1, 3.0));
    mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  return mesh;
}

TEST(TriangleDistance, AgreesWithDenseSampling) {
  const Stream stream(1, "bim.generate");
  constexpr int steps = 60;
  for (std::uint64_t tick = 0; tick < 60; ++tick) {
    const Eigen::Vector3d a = random_point(stream, tick, 0, 2.0);
    const Eigen::Vector3d b = random_point(stream, tick, 1, 2.0);
    const Eigen::Vector3d c = random_point(stream, tick, 2, 2.0);
    const Eigen::Vector3d p = random_point(stream, tick, 3, 3.0);
    double sampled = 1e9;
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; i + j <= steps; ++j)
        sampled = std::min(sampled, (a + (b - a) * i / steps + (c - a) * j / steps - p).norm());
    const double exact = triangle_distance(p, a, b, c);
    EXPECT_LE(exact, sampled + 1e-12);
    // No point of the triangle is farther than one step of both sides from a sample.
    EXPECT_GE(exact, sampled - ((b - a).norm() + (c - a).norm()) / steps);
  }
  EXPECT_NEAR(triangle_distance({3, 0, 0}, {0, 0, 0}, {1, 0, 0}, {2, 0, 0}), 1.0, 1e-12);  // without area
}

TEST(SurfaceDistance, AgreesWithBruteForceUpToTheCap) {
  const Stream stream(2, "bim.generate");
  for (std::uint64_t tick = 0; tick < 20; ++tick) {
    const bim::BuildingMesh mesh = random_mesh(stream, tick, 15);
    const SurfaceDistance distance(mesh, 0.5);
    for (std::uint32_t i = 0; i < 200; ++i) {
      const Eigen::Vector3d p = random_point(stream, 1000 + tick, i, 11.0) - Eigen::Vector3d::Ones();
      double brute = 0.5;
      for (const Eigen::Vector3i& t : mesh.triangles)
        brute = std::min(brute, triangle_distance(p, mesh.vertices[static_cast<std::size_t>(t[0])],
                                                  mesh.vertices[static_cast<std::size_t>(t[1])],
                                                  mesh.vertices[static_cast<std::size_t>(t[2])]));
      EXPECT_EQ(distance(p), brute);
    }
    EXPECT_EQ(distance({1e6, -1e6, 1e9}), 0.5);
  }
}

TEST(Completeness, AgreesWithBruteForce) {
  const Stream stream(3, "bim.generate");
  std::vector<Eigen::Vector3d> surface, map;
  for (std::uint32_t i = 0; i < 400; ++i) {
    surface.push_back(random_point(stream, 1, i, 1.0) - Eigen::Vector3d::Constant(0.5));
    map.push_back(random_point(stream, 2, i, 1.0) - Eigen::Vector3d::Constant(0.5));
  }
  for (const double within : {0.02, 0.05, 0.1, 0.2}) {
    const auto near = std::count_if(surface.begin(), surface.end(), [&](const auto& p) {
      return std::any_of(map.begin(), map.end(), [&](const auto& q) { return (p - q).norm() <= within; });
    });
    EXPECT_EQ(completeness(surface, map, within), static_cast<double>(near) / 400.0);
  }
  EXPECT_EQ(completeness(surface, {}, 0.05), 0.0);
  EXPECT_EQ(completeness(surface, surface, 0.05), 1.0);
}

TEST(ScoreMap, OfAFloorWithAnOutlier) {
  bim::BuildingMesh mesh;
  mesh.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  const SurfaceDistance distance(mesh, 0.5);
  const std::vector<Eigen::Vector3f> map = {{1, 1, 0.03F}, {2, 2, -0.04F}, {3, 3, 9.0F}};
  const MapScore score = score_map(map, Pose(), distance, {{1, 1, 0}, {2, 2, 0}, {3, 1, 0}, {1, 3, 0}});
  EXPECT_NEAR(score.rmse_m, std::sqrt((0.03 * 0.03 + 0.04 * 0.04 + 0.25) / 3.0), 1e-7);  // float coordinates
  EXPECT_NEAR(score.capped_share, 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(score.completeness, 0.5, 1e-12);
  // Moved together with its frame, the map scores the same.
  const Pose X_WF = Pose::from_xyz_yaw({1, 2, 0}, 0.7);
  std::vector<Eigen::Vector3f> map_F;
  for (const auto& p : map) map_F.push_back((X_WF.inverse() * p.cast<double>()).cast<float>());
  EXPECT_NEAR(score_map(map_F, X_WF, distance, {{1, 1, 0}}).rmse_m, score.rmse_m, 1e-6);
}

TEST(SurfaceDistance, RefusesABuildingThatReachesTooFar) {
  bim::BuildingMesh mesh;
  mesh.vertices = {{0, 0, 0}, {9000, 0, 0}, {0, 9000, 3}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_THROW(SurfaceDistance(mesh, 0.5), InputError);
}

}  // namespace
}  // namespace plumbline::scenarios::score
