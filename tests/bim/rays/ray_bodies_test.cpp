// SPDX-License-Identifier: Apache-2.0
#include "bim/rays/ray_bodies.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "bim/errors.h"
#include "bim/random/stream.h"
#include "bim/rays/ray_scene.h"
#include "tests/bim/rays/box_mesh.h"

namespace plumbline::bim {
namespace {

constexpr double range_max_m = 50.0;

MovingBody person(double radius, double height, std::vector<BodyStation> stations) {
  return {BodyShape::capsule, {-radius, -radius, 0.0}, {radius, radius, height}, 100, std::move(stations)};
}

MovingBody leaf(std::vector<BodyStation> stations) {
  return {BodyShape::box, {0.0, -0.02, 0.0}, {0.9, 0.02, 2.1}, 101, std::move(stations)};
}

class Random {
 public:
  explicit Random(std::uint64_t seed) : stream_(seed, "bim.generate") {}
  double uniform(double low, double high) { return low + (high - low) * stream_.uniform(next_++); }
  Eigen::Vector3d point(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  Ray ray() {
    const Eigen::Vector3d origin = point(4.0);
    return {origin, (point(1.5) - origin).normalized(), uniform(0.0, 2.0)};
  }

 private:
  Stream stream_;
  std::uint64_t next_ = 0;
};

/// Signed distance of a point in B from an upright capsule: negative inside.
double outside(const MovingBody& body, const Eigen::Vector3d& p) {
  const double r = body.high_B.x();
  const double z = std::min(std::max(p.z(), body.low_B.z() + r), body.high_B.z() - r);
  return (p - Eigen::Vector3d(0.0, 0.0, z)).norm() - r;
}

TEST(SymmetryBodies, RaysEndOnTheSurfaceOfACapsule) {
  Random random(1);
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const MovingBody body = person(random.uniform(0.1, 0.6), random.uniform(1.2, 2.0), {{0.0, random.point(1.0), 0.0}});
    const Ray ray = random.ray();
    const BodyHit hit = hit_body(body, ray);
    const auto p_B = [&](double range) -> Eigen::Vector3d {
      return ray.origin_W + range * ray.direction_W - body.stations[0].position_W;
    };
    const bool starts_inside = outside(body, p_B(0.0)) < 0.0;
    const double end = std::isinf(hit.range_m) ? 12.0 : hit.range_m;
    for (int k = 1; k < 60; ++k)  // nothing before the hit, and nothing at all without one
      ASSERT_TRUE((outside(body, p_B(end * k / 60.0)) < 1e-9) == starts_inside ||
                  std::abs(outside(body, p_B(end * k / 60.0))) < 1e-9);
    if (std::isinf(hit.range_m)) continue;
    ++hits;
    ASSERT_NEAR(outside(body, p_B(hit.range_m)), 0.0, 1e-9);
    const Eigen::Vector3d before = p_B(hit.range_m) - 1e-6 * hit.normal_W;
    ASSERT_LT(outside(body, before), 0.0);
    ASSERT_NEAR(hit.normal_W.norm(), 1.0, 1e-12);
  }
  EXPECT_GT(hits, 1000);
}

TEST(SymmetryBodies, ATurnedBoxIsHitLikeItsMesh) {
  Random random(2);
  for (int k = 0; k < 20; ++k) {
    const Eigen::Vector3d at = random.point(0.5);
    const double yaw = random.uniform(-4.0, 4.0);
    const MovingBody body = leaf({{0.0, at, yaw}});
    BuildingMesh mesh;
    add_box(mesh, body.low_B, body.high_B);
    const Eigen::Matrix3d R = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    for (Eigen::Vector3d& v : mesh.vertices) v = R * v + at;
    const RayScene scene(mesh);
    for (int i = 0; i < 1000; ++i) {
      const Ray ray = random.ray();
      const Hit expected = scene.cast(ray, range_max_m);
      const BodyHit hit = hit_body(body, ray);
      // Two formulas; rays along an edge may differ.
      if (std::isinf(expected.range_m) || std::isinf(hit.range_m)) {
        ASSERT_EQ(std::isinf(expected.range_m), std::isinf(hit.range_m)) << k << " " << i;
        continue;
      }
      ASSERT_NEAR(hit.range_m, expected.range_m, 1e-9);
      ASSERT_NEAR(std::abs(hit.normal_W.dot(expected.normal_W)), 1.0, 1e-9);
    }
  }
}

TEST(SymmetryBodies, MoveEvenlyBetweenStationsAndRestBeyond) {
  const MovingBody body = leaf({{1.0, {0, 0, 0}, 0.0}, {2.0, {2, 0, 0}, 1.0}, {4.0, {2, 4, 0}, 0.0}});
  EXPECT_EQ(station_at(body, 0.5).position_W, Eigen::Vector3d(0, 0, 0));
  EXPECT_NEAR((station_at(body, 1.25).position_W - Eigen::Vector3d(0.5, 0, 0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(station_at(body, 1.25).yaw, 0.25, 1e-12);
  EXPECT_NEAR((station_at(body, 3.0).position_W - Eigen::Vector3d(2, 2, 0)).norm(), 0.0, 1e-12);
  EXPECT_EQ(station_at(body, 9.0).position_W, Eigen::Vector3d(2, 4, 0));
}

/// Room of 8 m with two people crossing and a leaf that turns.
RayScene crowded_room(const RaySceneOptions& options) {
  RayScene scene(box_room({8, 8, 3}), options);
  MovingBody other = person(0.3, 1.6, {{0.0, {7, 2, 0}, 0.0}, {2.0, {1, 6, 0}, 0.0}});
  other.element = 102;
  scene.set_bodies({other, person(0.25, 1.75, {{0.0, {1, 2, 0}, 0.0}, {2.0, {7, 6, 0}, 0.0}}),
                    leaf({{0.0, {4, 0.1, 0}, 0.0}, {2.0, {4, 0.1, 0}, 1.5}})});
  return scene;
}

TEST(SymmetryBodies, EveryRayGetsTheNearestOfAllWhateverTravelsWithIt) {
  const RayScene narrow = crowded_room({.width = 1}), wide = crowded_room({.width = 16});
  RayScene empty(box_room({8, 8, 3}));
  Random random(3);
  std::vector<Ray> rays;
  for (int i = 0; i < 40000; ++i) {
    const double azimuth = 1e-3 * i, z = 0.2 * std::sin(0.37 * (i / 16));
    rays.push_back({{4 + 0.01 * (i % 5), 4, 1},
                    Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), z).normalized(),
                    random.uniform(0.0, 2.0)});
  }
  std::vector<Hit> a(rays.size()), b(rays.size()), c(rays.size());
  narrow.cast(rays, range_max_m, a);
  wide.cast(rays, range_max_m, b);
  empty.cast(rays, range_max_m, c);
  std::array<int, 3> seen{};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_EQ(a[i].element, b[i].element);
    ASSERT_EQ(a[i].range_m, b[i].range_m);
    ASSERT_EQ(a[i].normal_W, b[i].normal_W);
    ASSERT_LE(a[i].range_m, c[i].range_m);
    if (a[i].element < 100) {
      ASSERT_EQ(a[i].range_m, c[i].range_m);
      continue;
    }
    ++seen.at(static_cast<std::size_t>(a[i].element - 100));
    ASSERT_EQ(a[i].triangle, -1);
    ASSERT_LE(a[i].normal_W.dot(rays[i].direction_W), 0.0);
  }
  for (const int count : seen) EXPECT_GT(count, 100);
}

TEST(SymmetryBodies, WhatStandsWinsTies) {
  BuildingMesh mesh;
  add_box(mesh, {2, -1, 0}, {3, 1, 2});
  RayScene scene(mesh);
  MovingBody body{BodyShape::box, {0, -1, 0}, {1, 1, 2}, 7, {{0.0, {2 - 0.5e-4, 0, 0}, 0.0}}};
  scene.set_bodies({body});
  EXPECT_EQ(scene.cast({{0, 0, 1}, {1, 0, 0}}, range_max_m).element, 0);
  body.stations[0].position_W.x() = 2 - 2e-4;
  scene.set_bodies({body});
  EXPECT_EQ(scene.cast({{0, 0, 1}, {1, 0, 0}}, range_max_m).element, 7);
  EXPECT_EQ(scene.cast({{0, 0, 1}, {1, 0, 0}}, 1.5).element, -1);
}

TEST(SymmetryBodies, ABodyNeedsAPlaceAndExtent) {
  RayScene scene{BuildingMesh{}};
  EXPECT_THROW(scene.set_bodies({person(0.2, 1.7, {})}), InternalError);
  EXPECT_THROW(scene.set_bodies({person(0.0, 1.7, {{}})}), InternalError);
}

}  // namespace
}  // namespace plumbline::bim
