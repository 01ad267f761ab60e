// SPDX-License-Identifier: Apache-2.0
#include "bim/rays/ray_scene.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bim/digest/float_mode.h"
#include "bim/errors.h"
#include "bim/random/stream.h"
#include "tests/bim/rays/box_mesh.h"

namespace plumbline::bim {
namespace {

constexpr double range_max_m = 60.0;

/// Reference: every triangle, Moller-Trumbore in double, ties by the rule of the header.
Hit brute_force(const BuildingMesh& mesh, const Ray& ray) {
  std::vector<std::pair<double, int>> found;
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < static_cast<int>(mesh.triangles.size()); ++i) {
    const Eigen::Vector3i& t = mesh.triangles[static_cast<std::size_t>(i)];
    const Eigen::Vector3d& v0 = mesh.vertices[static_cast<std::size_t>(t[0])];
    const Eigen::Vector3d e1 = mesh.vertices[static_cast<std::size_t>(t[1])] - v0;
    const Eigen::Vector3d e2 = mesh.vertices[static_cast<std::size_t>(t[2])] - v0;
    const Eigen::Vector3d p = ray.direction_W.cross(e2);
    const double det = e1.dot(p);
    if (det == 0.0) continue;
    const Eigen::Vector3d s = ray.origin_W - v0;
    const double u = s.dot(p) / det;
    const Eigen::Vector3d q = s.cross(e1);
    const double v = ray.direction_W.dot(q) / det;
    const double range = e2.dot(q) / det;
    if (u < 0.0 || v < 0.0 || u + v > 1.0 || range <= 0.0 || range > range_max_m) continue;
    found.emplace_back(range, i);
    nearest = std::min(nearest, range);
  }
  Hit best;
  for (const auto& [range, i] : found) {
    const int element = mesh.element[static_cast<std::size_t>(i)];
    if (range > nearest + 1e-4 || (best.element >= 0 && best.element <= element)) continue;
    best = {range, element, i, Eigen::Vector3d::Zero()};
  }
  return best;
}

class RandomRays {
 public:
  explicit RandomRays(std::uint64_t seed) : stream_(seed, "bim.generate") {}
  double uniform(double low, double high) { return low + (high - low) * stream_.uniform(next_++); }
  Eigen::Vector3d point(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    return {uniform(low.x(), high.x()), uniform(low.y(), high.y()), uniform(low.z(), high.z())};
  }
  Eigen::Vector3d direction() {
    const double x = stream_.gauss(next_++);
    const double y = stream_.gauss(next_++);
    return Eigen::Vector3d(x, y, stream_.gauss(next_++)).normalized();
  }
  std::vector<Ray> rays(int count, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    std::vector<Ray> result;
    for (int i = 0; i < count; ++i) result.push_back({point(low, high), direction()});
    return result;
  }

 private:
  Stream stream_;
  std::uint64_t next_ = 0;
};

std::vector<Hit> cast_all(const RayScene& scene, const std::vector<Ray>& rays) {
  std::vector<Hit> hits(rays.size());
  scene.cast(rays, range_max_m, hits);
  return hits;
}

void expect_same(const Hit& a, const Hit& b, std::size_t i) {
  EXPECT_EQ(a.element, b.element) << "ray " << i;
  EXPECT_EQ(a.triangle, b.triangle) << "ray " << i;
  EXPECT_EQ(a.range_m, b.range_m) << "ray " << i;
  EXPECT_EQ(a.normal_W, b.normal_W) << "ray " << i;
}

/// Agreement with the reference: the same triangle, the range to 1e-9 m (two formulas, a few ulp at 60 m, divided by
/// the slope of grazing rays).
void expect_brute_force(const BuildingMesh& mesh, const std::vector<Ray>& rays) {
  const RayScene scene(mesh);
  const std::vector<Hit> hits = cast_all(scene, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit expected = brute_force(mesh, rays[i]);
    ASSERT_EQ(hits[i].element, expected.element) << "ray " << i;
    ASSERT_EQ(hits[i].triangle, expected.triangle) << "ray " << i;
    if (expected.element < 0) continue;
    ASSERT_NEAR(hits[i].range_m, expected.range_m, 1e-9) << "ray " << i;
    ASSERT_LE(hits[i].normal_W.dot(rays[i].direction_W), 0.0);
    ASSERT_NEAR(hits[i].normal_W.norm(), 1.0, 1e-12);
  }
}

BuildingMesh random_soup(std::uint64_t seed, int triangles, double size) {
  RandomRays random(seed);
  BuildingMesh mesh;
  for (int i = 0; i < triangles; ++i) {
    const Eigen::Vector3d a = random.point({-10, -10, -3}, {10, 10, 3});
    add_element(mesh, {a, a + size * random.direction(), a + size * random.direction()}, {{0, 1, 2}});
  }
  return mesh;
}

/// Rooms of overlapping boxes: duplicate walls, flush walls, walls ending inside others, turned boxes, far from the
/// origin.
BuildingMesh random_building(std::uint64_t seed, const Eigen::Vector3d& origin) {
  RandomRays random(seed);
  BuildingMesh mesh;
  for (int i = 0; i < 12; ++i) {
    const double x = std::round(random.uniform(0, 8)) * 2.0;
    const double y = std::round(random.uniform(0, 5)) * 2.0;
    const bool along_x = random.uniform(0, 1) < 0.5;
    const Eigen::Vector3d low = origin + Eigen::Vector3d(x, y, 0.0);
    const Eigen::Vector3d size = along_x ? Eigen::Vector3d(6.0, 0.2, 3.0) : Eigen::Vector3d(0.2, 6.0, 3.0);
    add_box(mesh, low, low + size);
    if (i % 4 == 0) add_box(mesh, low, low + size);                                 // duplicate
    if (i % 4 == 1) add_box(mesh, low, low + Eigen::Vector3d(2.0, 2.0, 3.0), 0.3);  // turned
  }
  add_box(mesh, origin + Eigen::Vector3d(-1, -1, -0.2), origin + Eigen::Vector3d(25, 20, 0));
  add_box(mesh, origin + Eigen::Vector3d(-1, -1, 3.0), origin + Eigen::Vector3d(25, 20, 3.2));
  return mesh;
}

TEST(RayScene, MatchesBruteForceOnRandomSoups) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const BuildingMesh mesh = random_soup(seed, 300, 0.05 * std::pow(5.0, static_cast<double>(seed - 1)));
    expect_brute_force(mesh, RandomRays(100 + seed).rays(4000, {-10, -10, -3}, {10, 10, 3}));
  }
}

TEST(RayScene, MatchesBruteForceInBuildingsWithCoplanarAndCrossingWalls) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Eigen::Vector3d origin(seed % 2 == 0 ? 500.0 : 0.0, seed % 3 == 0 ? -300.0 : 0.0, 0.0);
    const BuildingMesh mesh = random_building(seed, origin);
    const Eigen::Vector3d high = origin + Eigen::Vector3d(22, 16, 2.9);
    expect_brute_force(mesh, RandomRays(200 + seed).rays(4000, origin + Eigen::Vector3d(0, 0, 0.1), high));
  }
}

TEST(RayScene, MatchesBruteForceInACutAndMeshedBuilding) {
  Building building;
  building.storeys.push_back({"ground", "ground", 0.0, 3.0, 0});
  const auto wall = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    Wall& w = building.walls.emplace_back();
    w.id = "w" + std::to_string(building.walls.size());
    w.storey = 0;
    w.a = a;
    w.b = b;
    w.offset_m = -0.5 * w.thickness_m;
  };
  wall({0, 0}, {8, 0});
  wall({8, 0}, {8, 5});
  wall({8, 5}, {0, 5});
  wall({0, 5}, {0, 0});
  wall({4, 0}, {4, 5});
  wall({0, 2}, {4, 3});
  for (int w = 0; w < 6; ++w) {
    Opening& door = building.openings.emplace_back();
    door.id = "d" + std::to_string(w);
    door.wall = w;
    door.s_m = 1.5 + 0.2 * w;
  }
  Slab& slab = building.slabs.emplace_back();
  slab.id = "slab";
  slab.storey = 0;
  slab.polygon.outer = {{-1, -1}, {9, -1}, {9, 6}, {-1, 6}};
  const BuildingMesh mesh = build_mesh(building);
  ASSERT_GT(mesh.triangles.size(), 100U);
  expect_brute_force(mesh, RandomRays(31).rays(20000, {0.2, 0.2, 0.1}, {7.8, 4.8, 2.9}));
}

TEST(RayScene, MatchesBruteForceNextToEdges) {
  const BuildingMesh mesh = random_building(3, Eigen::Vector3d::Zero());
  RandomRays random(7);
  std::vector<Ray> rays;
  for (int i = 0; i < 20000; ++i) {
    const auto t = static_cast<std::size_t>(random.uniform(0, static_cast<double>(mesh.triangles.size())));
    const auto k = static_cast<int>(random.uniform(0, 3));
    const Eigen::Vector3d a = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])];
    const Eigen::Vector3d b = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][(k + 1) % 3])];
    // From 1e-8 m (below float) to 1e-3 m beside the edge.
    const double beside = std::pow(10.0, random.uniform(-8, -3));
    const Eigen::Vector3d target = a + random.uniform(0, 1) * (b - a) + beside * random.direction();
    const Eigen::Vector3d origin = random.point({0, 0, 0.1}, {22, 16, 2.9});
    rays.push_back({origin, (target - origin).normalized()});
  }
  expect_brute_force(mesh, rays);
}

TEST(RayScene, SingleRaysAndPacketsAgree) {
  const BuildingMesh mesh = random_building(5, Eigen::Vector3d::Zero());
  const RayScene scene(mesh);
  const std::vector<Ray> rays = RandomRays(11).rays(20003, {0, 0, 0.1}, {22, 16, 2.9});
  const std::vector<Hit> hits = cast_all(scene, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) expect_same(scene.cast(rays[i], range_max_m), hits[i], i);
}

TEST(RayScene, InstructionSetsAgree) {
  const BuildingMesh mesh = random_building(6, Eigen::Vector3d(40, 30, 0));
  const std::vector<Ray> rays = RandomRays(12).rays(40000, {40, 30, 0.1}, {62, 46, 2.9});
  const std::vector<Hit> expected = cast_all(RayScene(mesh), rays);
  int compared = 0;
  for (const char* isa : {"isa=sse2", "isa=sse4.2", "isa=avx", "isa=avx2", "isa=avx512"}) {
    std::optional<RayScene> scene;
    try {
      scene.emplace(mesh, RaySceneOptions{.embree = isa});
    } catch (const EnvironmentError&) {
      continue;  // this CPU has no such instructions
    }
    const std::vector<Hit> hits = cast_all(*scene, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) expect_same(hits[i], expected[i], i);
    ++compared;
  }
  EXPECT_GE(compared, 2);
}

TEST(RayScene, ClosedRoomLetsNoRayOut) {
  const BuildingMesh mesh = box_room({5, 4, 3});
  const RayScene scene(mesh);
  std::vector<Ray> rays = RandomRays(13).rays(50000, {0.1, 0.1, 0.1}, {4.9, 3.9, 2.9});
  for (std::size_t i = 0; i < 5000; ++i) {  // straight at corners, edges and diagonals
    const Eigen::Vector3d corner(i % 2 == 0 ? 0.0 : 5.0, i % 4 < 2 ? 0.0 : 4.0,
                                 i % 3 == 0 ? 3.0 : 0.003 * static_cast<double>(i % 1000));
    rays[i].direction_W = (corner - rays[i].origin_W).normalized();
  }
  for (const Hit& hit : cast_all(scene, rays)) {
    ASSERT_GE(hit.element, 0);
    ASSERT_LE(hit.range_m, 7.1);
  }
}

/// Whose floats are coarse where the room is.
TEST(RayScene, SomethingFarAwayChangesNoHit) {
  const BuildingMesh room = box_room({5, 4, 3});
  std::vector<Ray> rays = RandomRays(23).rays(100000, {0.1, 0.1, 0.1}, {4.9, 3.9, 2.9});
  for (std::size_t i = 0; i < 20000; ++i) {
    const Eigen::Vector3d corner(i % 2 == 0 ? 0.0 : 5.0, i % 4 < 2 ? 0.0 : 4.0,
                                 i % 3 == 0 ? 3.0 : 0.003 * static_cast<double>(i % 1000));
    rays[i].direction_W = (corner - rays[i].origin_W).normalized();
  }
  const std::vector<Hit> alone = cast_all(RayScene(room), rays);
  for (const double far_m : {600.0, 2000.0, 9900.0}) {
    BuildingMesh mesh = room;
    add_box(mesh, {far_m, 5, 0}, {far_m + 1, 6, 3});
    const std::vector<Hit> hits = cast_all(RayScene(mesh), rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(hits[i].range_m, alone[i].range_m) << far_m;
      ASSERT_EQ(hits[i].triangle, alone[i].triangle) << far_m;
    }
  }
}

TEST(RayScene, ThousandsOfTrianglesInOnePlaceAreRefused) {
  const std::vector<Eigen::Vector3d> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const auto stacked = [&](std::size_t count) {
    BuildingMesh mesh;
    add_element(mesh, corners, std::vector<Eigen::Vector3i>(count, Eigen::Vector3i(0, 1, 2)));
    return mesh;
  };
  EXPECT_EQ(RayScene(stacked(300)).cast({{0.2, 0.2, 1}, {0, 0, -1}}, range_max_m).triangle, 0);
  EXPECT_THROW(RayScene{stacked(4000)}, InputError);
}

TEST(RayScene, ARayInABoxMeetsTheTriangleItHitsAndTheOneBehindIt) {
  BuildingMesh mesh;
  add_box(mesh, {0, 0, 0}, {5, 4, 3}, 0.3);
  const RayScene scene(mesh);
  for (const Ray& ray : RandomRays(17).rays(2000, {1.5, 1.2, 0.1}, {3.5, 2.8, 2.9})) {
    const Ray back{ray.origin_W, -ray.direction_W};
    const int hit = scene.cast(ray, range_max_m).triangle;
    const int behind = scene.cast(back, range_max_m).triangle;
    for (int i = 0; i < static_cast<int>(mesh.triangles.size()); ++i)
      EXPECT_EQ(scene.meets(i, ray), i == hit || i == behind);
  }
}

TEST(RayScene, DuplicateWallsGoToTheLowestElement) {
  BuildingMesh mesh;
  add_box(mesh, {5, -5, -5}, {6, 5, 5});
  add_box(mesh, {5, -5, -5}, {6, 5, 5});
  add_box(mesh, {5 + 0.9e-4, -5, -5}, {6, 5, 5});  // 0.09 mm behind
  const RayScene scene(mesh);
  for (const Ray& ray : RandomRays(14).rays(2000, {0, -1, -1}, {1, 1, 1})) {
    const Hit hit = scene.cast(ray, range_max_m);
    EXPECT_LE(hit.element, 0);
  }
}

TEST(RayScene, RangeEndsWhereAsked) {
  BuildingMesh mesh;
  add_box(mesh, {5, -5, -5}, {6, 5, 5});
  const RayScene scene(mesh);
  const Ray ray{{0, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(scene.cast(ray, 5.0).element, 0);
  EXPECT_EQ(scene.cast(ray, 5.0).range_m, 5.0);
  EXPECT_EQ(scene.cast(ray, 5.0 - 1e-9).element, -1);
  EXPECT_TRUE(std::isinf(scene.cast(ray, 4.0).range_m));
}

TEST(RayScene, EmptyMeshIsMissed) {
  const RayScene scene{BuildingMesh{}};
  EXPECT_EQ(scene.cast({{0, 0, 0}, {1, 0, 0}}, range_max_m).element, -1);
}

TEST(RayScene, LeavesTheFloatingPointModeAlone) {
  const BuildingMesh mesh = box_room({5, 4, 3});
  for (const unsigned mode : {0x1f80U, required_float_mode}) {
    __builtin_ia32_ldmxcsr(mode);
    {
      const RayScene scene(mesh);
      EXPECT_EQ(float_mode(), mode);
      (void)scene.cast({{1, 1, 1}, {1, 0, 0}}, range_max_m);
      EXPECT_EQ(float_mode(), mode);
    }
    EXPECT_EQ(float_mode(), mode);
  }
  set_float_mode();
}

}  // namespace
}  // namespace plumbline::bim
