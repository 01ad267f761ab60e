// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/collision.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bim/errors.h"
#include "bim/random/stream.h"

namespace plumbline::sim {
namespace {

/// One storey with one wall from a to b.
bim::Building one_wall(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  bim::Building building;
  building.storeys.push_back({.id = "ground", .name = "ground"});
  bim::Wall wall;
  wall.storey = 0;
  wall.a = a;
  wall.b = b;
  wall.offset_m = -0.05;
  building.walls.push_back(wall);
  return building;
}

bim::Opening opening(double s, double width, double z0, double z1) {
  bim::Opening o;
  o.wall = 0;
  o.s_m = s;
  o.width_m = width;
  o.z0_m = z0;
  o.z1_m = z1;
  return o;
}

/// So that lintels and whole walls are seen.
CollisionConfig whole_height() {
  CollisionConfig config;
  config.reach_m = 10.0;
  return config;
}

bool inside_any(const std::vector<CollisionBox>& boxes, const Eigen::Vector3d& p) {
  for (const CollisionBox& box : boxes)
    if (distance(box, p) <= 0.0) return true;
  return false;
}

double total_volume(const std::vector<CollisionBox>& boxes) {
  double sum = 0.0;
  for (const CollisionBox& box : boxes) sum += 8.0 * box.half.prod();
  return sum;
}

bool in_opening(const bim::Opening& o, double s, double z) {
  return std::abs(s - o.s_m) < 0.5 * o.width_m && z > o.z0_m && z < o.z1_m;
}

/// An upright prism over a counter-clockwise outline that is star-shaped from its first corner.
void add_prism(const Polygon2& outline, double z0, double z1, bim::Solid& solid) {
  const int first = static_cast<int>(solid.vertices.size()), n = static_cast<int>(outline.size());
  for (const double z : {z0, z1})
    for (const Eigen::Vector2d& p : outline) solid.vertices.emplace_back(p.x(), p.y(), z);
  for (int i = 0; i < n; ++i) {
    const int a = first + i, b = first + (i + 1) % n;
    solid.triangles.emplace_back(a, b, b + n);
    solid.triangles.emplace_back(a, b + n, a + n);
    if (i == 0 || i + 1 == n) continue;
    solid.triangles.emplace_back(first, b, a);
    solid.triangles.emplace_back(first + n, a + n, b + n);
  }
}

TEST(Collision, AWallWithAGapInItsBodyIsOpenThere) {
  bim::Building building = one_wall({0.0, 0.0}, {6.0, 0.0});
  bim::Solid body;
  add_prism({{0, -0.05}, {2, -0.05}, {2, 0.15}, {0, 0.15}}, 0.0, 3.0, body);
  add_prism({{3.2, -0.05}, {6, -0.05}, {6, 0.15}, {3.2, 0.15}}, 0.0, 3.0, body);
  building.walls[0].body = body;
  const std::vector<CollisionBox> boxes = collision_boxes(building, {0});
  for (const double z : {0.1, 0.5, 1.0}) {
    EXPECT_FALSE(inside_any(boxes, {2.6, 0.05, z}));
    EXPECT_TRUE(inside_any(boxes, {1.0, -0.05, z}));
    EXPECT_TRUE(inside_any(boxes, {2.0, 0.05, z}));
    EXPECT_TRUE(inside_any(boxes, {5.0, 0.15, z}));
  }
}

TEST(Collision, ACurvedWallIsWhereItsBodyIs) {
  // A bow from (0, 0) over (3, 1.5) to (6, 0), 0.2 m thick, with a door in its middle.
  bim::Building building = one_wall({0.0, 0.0}, {6.0, 0.0});
  bim::Wall& wall = building.walls[0];
  bim::Solid body;
  const auto at = [](int i) { return Eigen::Vector2d(0.5 * i, 1.5 * std::sin(std::numbers::pi * i / 12.0)); };
  for (int i = 0; i < 12; ++i)
    add_prism({at(i), at(i + 1), at(i + 1) + Eigen::Vector2d(0.0, 0.2), at(i) + Eigen::Vector2d(0.0, 0.2)}, 0.0, 3.0,
              body);
  wall.body = body;
  wall.offset_m = 0.0;
  wall.thickness_m = 1.7;
  building.openings = {opening(3.0, 1.0, 0.0, 2.1)};
  const std::vector<CollisionBox> boxes = collision_boxes(building, {0});
  EXPECT_FALSE(inside_any(boxes, {3.0, 0.3, 0.5})) << "under the bow";
  EXPECT_FALSE(inside_any(boxes, {3.0, 1.6, 0.5})) << "in the doorway";
  EXPECT_TRUE(inside_any(boxes, {1.5, at(3).y(), 0.5}));
  EXPECT_TRUE(inside_any(boxes, {4.5, at(9).y() + 0.2, 0.5}));
}

TEST(Collision, WallBoxesFillTheWallButNotItsOpenings) {
  bim::Building building = one_wall({1.0, 2.0}, {7.0, 5.0});
  building.openings = {opening(1.5, 0.9, 0.0, 2.1), opening(4.0, 1.2, 0.9, 2.2), opening(4.8, 1.0, 0.5, 1.5)};
  const bim::Wall& wall = building.walls[0];
  const std::vector<CollisionBox> boxes = collision_boxes(building, {0}, whole_height());

  const Stream stream(1, "bim.generate");
  for (std::uint64_t i = 0; i < 5000; ++i) {
    const double s = -0.5 + (wall.length() + 1.0) * stream.uniform(i, 0);
    const double t = -0.3 + 0.6 * stream.uniform(i, 1);
    const double z = -0.5 + 4.0 * stream.uniform(i, 2);
    const Eigen::Vector2d p = wall.a + s * wall.direction() + t * wall.left();
    bool solid = s > 0.0 && s < wall.length() && t > -0.05 && t < 0.15 && z > 0.0 && z < 3.0;
    for (const bim::Opening& o : building.openings) solid = solid && !in_opening(o, s, z);
    EXPECT_EQ(inside_any(boxes, {p.x(), p.y(), z}), solid) << "s " << s << " t " << t << " z " << z;
  }
  // Openings 2 and 3 overlap on s in [4.3, 4.6], z in [0.9, 1.5].
  const double cut = 0.9 * 2.1 + 1.2 * 1.3 + 1.0 * 1.0 - 0.3 * 0.6;
  EXPECT_NEAR(total_volume(boxes), 0.2 * (3.0 * wall.length() - cut), 1e-9);
}

TEST(Collision, ADoorInReachHasNoLintel) {
  bim::Building building = one_wall({0.0, 0.0}, {4.0, 0.0});
  building.openings = {opening(2.0, 0.9, 0.0, 2.1)};
  EXPECT_EQ(collision_boxes(building, {0}).size(), 2U);
  EXPECT_EQ(collision_boxes(building, {0}, whole_height()).size(), 3U);
}

TEST(Collision, AClosedLeafBlocks) {
  bim::Building building = one_wall({0.0, 0.0}, {4.0, 0.0});
  building.openings = {opening(2.0, 0.9, 0.0, 2.1)};
  building.openings[0].leaf = bim::Leaf::closed;
  EXPECT_TRUE(inside_any(collision_boxes(building, {0}), {2.0, 0.0, 0.5}));
}

TEST(Collision, LongWallsAreSplit) {
  const std::vector<CollisionBox> boxes = collision_boxes(one_wall({0.0, 0.0}, {10.0, 0.0}), {0});
  ASSERT_EQ(boxes.size(), 3U);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    EXPECT_EQ(boxes[i].id, static_cast<int>(i));
    EXPECT_NEAR(boxes[i].half.x(), 10.0 / 6.0, 1e-12);
  }
}

TEST(Collision, AYawedColumnGetsItsOwnRectangle) {
  bim::Building building = one_wall({0.0, 0.0}, {1.0, 0.0});
  building.walls.clear();
  bim::Column column;
  const Pose X = Pose::from_xyz_yaw({3.0, 1.0, 0.0}, 0.5235987755982988);  // 30 degrees, one of the directions tried
  for (const auto& [x, y] : {std::pair{0.4, 0.2}, {-0.4, 0.2}, {-0.4, -0.2}, {0.4, -0.2}})
    column.footprint.emplace_back((X * Eigen::Vector3d(x, y, 0.0)).head<2>());
  building.columns.push_back(column);
  const std::vector<CollisionBox> boxes = collision_boxes(building, {0});
  ASSERT_EQ(boxes.size(), 1U);
  EXPECT_NEAR(4.0 * boxes[0].half.x() * boxes[0].half.y(), 0.32, 1e-9);
  EXPECT_NEAR((boxes[0].X_WB.t.head<2>() - Eigen::Vector2d(3.0, 1.0)).norm(), 0.0, 1e-9);
}

/// Closed box between two corners.
bim::Solid box_solid(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  bim::Solid solid;
  for (int i = 0; i < 8; ++i)
    solid.vertices.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                                (i & 4) != 0 ? high.z() : low.z());
  solid.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                     {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return solid;
}

bim::Solid joined(bim::Solid a, const bim::Solid& b) {
  const auto shift = static_cast<int>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Eigen::Vector3i& t : b.triangles) a.triangles.emplace_back(t.array() + shift);
  return a;
}

bim::Building only(const bim::Solid& solid) {
  bim::Building building = one_wall({0.0, 0.0}, {1.0, 0.0});
  building.walls.clear();
  bim::Obstacle obstacle;
  obstacle.body = solid;
  building.obstacles.push_back(obstacle);
  return building;
}

TEST(Collision, WhatLiesFlatOrHighIsNoObstacle) {
  const auto slab = [](double z) { return only(box_solid({0.0, 0.0, z}, {1.0, 1.0, z + 0.21})); };
  EXPECT_TRUE(collision_boxes(slab(-0.2), {0}).empty());
  EXPECT_TRUE(collision_boxes(slab(2.0), {0}).empty());
  const std::vector<CollisionBox> boxes = collision_boxes(slab(0.3), {0});
  ASSERT_EQ(boxes.size(), 1U);
  EXPECT_NEAR(boxes[0].X_WB.t.z(), 0.405, 1e-12);
  EXPECT_NEAR(boxes[0].half.prod(), 0.5 * 0.5 * 0.105, 1e-12);
}

TEST(Collision, OnlyThePartInReachOfAnObstacleBlocks) {
  // A beam that rises from the floor at x = 0 to 4 m at x = 4, as a stair's string does.
  bim::Solid beam = box_solid({0.0, 0.0, 0.0}, {4.0, 0.1, 0.2});
  for (Eigen::Vector3d& v : beam.vertices) v.z() += v.x();
  const std::vector<CollisionBox> boxes = collision_boxes(only(beam), {0});
  EXPECT_TRUE(inside_any(boxes, {0.5, 0.05, 0.6}));
  EXPECT_FALSE(inside_any(boxes, {1.5, 0.05, 0.6}));
  for (const CollisionBox& box : boxes) EXPECT_LT(box.X_WB.t.x() + box.half.x(), 1.2 + 0.11);
}

TEST(Collision, UnderACounterOnLegsItIsFree) {
  bim::Solid counter = box_solid({0.0, 0.0, 1.07}, {2.4, 0.8, 1.1});
  for (const double x : {0.0, 2.35})
    for (const double y : {0.0, 0.75}) counter = joined(counter, box_solid({x, y, 0.0}, {x + 0.05, y + 0.05, 1.07}));
  const std::vector<CollisionBox> boxes = collision_boxes(only(counter), {0});
  EXPECT_FALSE(inside_any(boxes, {1.2, 0.4, 0.5}));
  EXPECT_FALSE(inside_any(boxes, {1.2, 0.02, 0.5})) << "between two legs";
  EXPECT_FALSE(inside_any(boxes, {0.02, 0.4, 0.5})) << "between two legs";
  EXPECT_TRUE(inside_any(boxes, {0.02, 0.02, 0.5})) << "a leg";
  EXPECT_TRUE(inside_any(boxes, {1.2, 0.4, 1.08})) << "the top";
}

TEST(Collision, OfAThingTooLargeForCellsOnlyWhatIsNearTheRoomsIsKept) {
  const bim::Solid fence =
      joined(box_solid({-600.0, 1.0, 0.0}, {600.0, 1.05, 1.0}), box_solid({-600.0, 1.05, 0.0}, {-599.95, 600.0, 1.0}));
  bim::Building building = only(fence);
  EXPECT_THROW((void)collision_boxes(building, {0}), InputError);  // nothing says where the robot may be
  building.walls = one_wall({0.0, 0.0}, {10.0, 0.0}).walls;
  building.walls[0].storey = 0;
  const std::vector<CollisionBox> boxes = collision_boxes(building, {0});
  EXPECT_LT(boxes.size(), 10U);
  EXPECT_TRUE(inside_any(boxes, {-1.9, 1.02, 0.5}));
  EXPECT_TRUE(inside_any(boxes, {11.9, 1.02, 0.5}));
  EXPECT_FALSE(inside_any(boxes, {5.0, 1.5, 0.5}));
  EXPECT_FALSE(inside_any(boxes, {20.0, 1.02, 0.5}));
}

TEST(Collision, AnObstacleRoundACornerLeavesTheCornerFree) {
  // Two rails, 3 m and 2 m long, that meet in a right angle; their bounding box would fill 6 m^2.
  const bim::Building building =
      only(joined(box_solid({0.0, 0.0, 0.0}, {3.0, 0.05, 1.0}), box_solid({0.0, 0.05, 0.0}, {0.05, 2.0, 1.0})));
  const std::vector<CollisionBox> boxes = collision_boxes(building, {0});
  EXPECT_LE(boxes.size(), 4U);
  double covered = 0.0;
  for (const CollisionBox& box : boxes) covered += 4.0 * box.half.x() * box.half.y();
  EXPECT_LT(covered, 0.75);  // 5 m of rail, at most a cell and a half wide
  EXPECT_FALSE(inside_any(boxes, {1.5, 1.0, 0.5}));
  const Stream stream(2, "bim.generate");
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const double s = 5.0 * stream.uniform(i, 0);
    const Eigen::Vector2d p = s < 3.0 ? Eigen::Vector2d(s, 0.0) : Eigen::Vector2d(0.0, s - 3.0);
    const double z = 0.03 + 0.96 * stream.uniform(i, 1);
    EXPECT_TRUE(inside_any(boxes, {p.x(), p.y(), z})) << p.transpose() << " " << z;
  }
}

bim::Building only_column(const bim::Solid& body) {
  bim::Building building = one_wall({0.0, 0.0}, {1.0, 0.0});
  building.walls.clear();
  bim::Column column;
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, {2.0, 0.0}, {2.0, 2.0}, {0.0, 2.0}})
    column.footprint.emplace_back(x, y);
  column.body = body;
  building.columns.push_back(column);
  return building;
}

TEST(Collision, AColumnIsWhereItsBodyIs) {
  // A head of 2 m by 2 m above the robot, and an L of 2 m and 0.3 m.
  const bim::Solid stem = box_solid({0.8, 0.8, 0.0}, {1.2, 1.2, 2.5}), head = box_solid({0, 0, 2.5}, {2, 2, 3});
  const std::vector<CollisionBox> mushroom = collision_boxes(only_column(joined(stem, head)), {0});
  EXPECT_TRUE(inside_any(mushroom, {1.0, 1.0, 0.5}));
  EXPECT_FALSE(inside_any(mushroom, {0.5, 1.0, 0.5}));
  bim::Solid angle;
  add_prism({{0, 0}, {2, 0}, {2, 0.3}, {0.3, 0.3}, {0.3, 2}, {0, 2}}, 0.0, 3.0, angle);
  const std::vector<CollisionBox> corner = collision_boxes(only_column(angle), {0});
  EXPECT_TRUE(inside_any(corner, {0.28, 1.5, 0.5}));
  EXPECT_TRUE(inside_any(corner, {1.5, 0.28, 0.5}));
  EXPECT_FALSE(inside_any(corner, {1.2, 1.2, 0.5}));
}

TEST(Collision, AColumnWithoutAnOutlineIsItsBodyOrNothing) {
  bim::Building building = only_column(box_solid({0.8, 0.8, 0.0}, {1.2, 1.2, 3.0}));
  building.columns[0].footprint.clear();
  EXPECT_EQ(collision_boxes(building, {0}).size(), 1U);
  building.columns[0].body.reset();
  EXPECT_TRUE(collision_boxes(building, {0}).empty());
}

}  // namespace
}  // namespace plumbline::sim
