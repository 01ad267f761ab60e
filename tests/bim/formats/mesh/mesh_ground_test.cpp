// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/mesh/mesh_ground.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "bim/formats/mesh/mesh_world.h"
#include "bim/geometry/polygon_boolean.h"
#include "tests/bim/formats/mesh/box_obj.h"

namespace plumbline::bim {
namespace {

constexpr double hall_x = 24.0, hall_y = 12.0;

/// A hall with a level roof over a floor of this height.
Building hall_over(int nx, int ny, const std::function<double(int, int)>& height) {
  BoxObj obj;
  obj.sheet(hall_x, hall_y, nx, ny, height);
  obj.walls(hall_x, hall_y, -1.0, 4.0, 0.3);
  obj.box({0, 0, 4.0}, {hall_x, hall_y, 4.3});
  return read_mesh_world(obj.text(), "hall.obj");
}

double floor_m2(const Building& building) {
  double sum = 0.0;
  for (const Slab& slab : building.slabs) sum += area({slab.polygon});
  return sum;
}

std::size_t ground_warnings(const Building& building) {
  return static_cast<std::size_t>(std::count_if(building.warnings.begin(), building.warnings.end(),
                                                [](const Warning& w) { return w.kind == "assumed_ground"; }));
}

/// In two triangles as in many: no layer holds half as much of the floor as there is roof.
TEST(MeshGround, AFloorThatFallsTowardsADrainIsTheGround) {
  for (const int n : {1, 12, 60})
    for (const double rise : {0.2, 0.4, 0.6}) {
      const Building hall = hall_over(n, n, [&](int i, int) { return rise * i / n; });
      EXPECT_NEAR(hall.storeys.front().elevation_m, 0.5 * rise, 0.03) << n << " " << rise;
      EXPECT_NEAR(floor_m2(hall), hall_x * hall_y, 0.1) << n << " " << rise;
      EXPECT_LT(hall.slabs.front().z1_m, 0.0);
      EXPECT_EQ(ground_warnings(hall), 1u);
    }
}

/// Of a floor that falls by a metre what lies within reach of its mean has a slab.
TEST(MeshGround, ASteeperFloorIsTheGroundWhereItIsNear) {
  const Building hall = hall_over(1, 1, [](int i, int) { return 1.0 * i; });
  EXPECT_NEAR(hall.storeys.front().elevation_m, 0.5, 0.03);
  EXPECT_NEAR(floor_m2(hall), 0.8 * hall_x * hall_y, 10.0);
  EXPECT_EQ(ground_warnings(hall), 1u);
}

/// Hardly a triangle of it is level.
TEST(MeshGround, ARoughFloorIsTheGround) {
  const Building hall =
      hall_over(240, 120, [](int i, int j) { return 0.03 * ((7 * i + 5 * j + i * j) % 11 - 5) / 5.0; });
  EXPECT_NEAR(hall.storeys.front().elevation_m, 0.0, 0.02);
  EXPECT_NEAR(floor_m2(hall), hall_x * hall_y, 3.0);
  EXPECT_LT(hall.slabs.front().z1_m, -0.03);
  EXPECT_EQ(ground_warnings(hall), 0u);
}

TEST(MeshGround, OfAFloorWithAStepTheLowerPartIsTheGround) {
  BoxObj obj;
  obj.box({0, 0, -0.2}, {14, hall_y, 0});
  obj.box({14, 0, -0.2}, {hall_x, hall_y, 0.12});
  obj.box({0, 0, 4.0}, {hall_x, hall_y, 4.3});
  const Building hall = read_mesh_world(obj.text(), "hall.obj");
  EXPECT_NEAR(hall.storeys.front().elevation_m, 0.0, 1e-6);
  EXPECT_NEAR(floor_m2(hall), 14 * hall_y, 0.1);
  EXPECT_EQ(ground_warnings(hall), 0u);
}

/// Tiers of a lecture room: none is large.
TEST(MeshGround, FloorsBelowThatAreAsLargeTogetherAreTold) {
  BoxObj obj;
  for (int i = 0; i < 6; ++i) obj.box({4.0 * i, 0, -1.0}, {4.0 * (i + 1), hall_y, 0.4 * i});
  obj.box({0, 0, 5.0}, {hall_x, hall_y, 5.3});
  const Building hall = read_mesh_world(obj.text(), "hall.obj");
  EXPECT_NEAR(hall.storeys.front().elevation_m, 5.3, 1e-6);
  EXPECT_EQ(ground_warnings(hall), 1u);
}

}  // namespace
}  // namespace plumbline::bim
