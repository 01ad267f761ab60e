// SPDX-License-Identifier: Apache-2.0
#include "bim/furniture/alter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/furniture/furnish.h"
#include "tests/bim/furniture/walkable.h"

namespace plumbline::bim {
namespace {

/// Two rooms with furniture of density 0.2, a box of the plan and one of the building site.
Building furnished() {
  Building b = read_plan_text(
      "plan: 1\n"
      "storeys: [{id: g, elevation_m: 1}]\n"
      "walls:\n"
      "  - {id: s, storey: g, a: [0, 0], b: [12, 0]}\n"
      "  - {id: e, storey: g, a: [12, 0], b: [12, 6]}\n"
      "  - {id: n, storey: g, a: [12, 6], b: [0, 6]}\n"
      "  - {id: w, storey: g, a: [0, 6], b: [0, 0]}\n"
      "  - {id: m, storey: g, a: [6, 0], b: [6, 6]}\n"
      "openings: [{id: d, wall: m, s_m: 3}, {id: out, wall: s, s_m: 2}]\n"
      "rooms:\n"
      "  - {id: office, storey: g, polygon: [[0, 0], [6, 0], [6, 6], [0, 6]]}\n"
      "  - {id: living, storey: g, polygon: [[6, 0], [12, 0], [12, 6], [6, 6]]}\n"
      "clutter: [{id: crate, storey: g, shape: box, at: [3, 4], size: [0.6, 0.6]}]\n",
      "two.plan.yaml");
  Obstacle site = b.obstacles.front();
  site.id = "site";
  site.planned = false;
  for (Eigen::Vector3d& p : site.body.vertices) p.x() += 6.0;
  b.obstacles.push_back(site);
  FurnishOptions options;
  options.density = 0.2;
  for (Obstacle& piece : furnish(b, options)) b.obstacles.push_back(std::move(piece));
  return b;
}

std::vector<Polygon2> standing(const Building& b) {
  std::vector<Polygon2> outlines;
  for (const Obstacle& obstacle : b.obstacles) outlines.push_back(hull_of(obstacle));
  return outlines;
}

std::map<std::string, Obstacle> by_id(const Building& b) {
  std::map<std::string, Obstacle> obstacles;
  for (const Obstacle& obstacle : b.obstacles) EXPECT_TRUE(obstacles.emplace(obstacle.id, obstacle).second);
  return obstacles;
}

Building altered(FurnitureWorld world, std::uint64_t seed, FurnitureChanges* changes = nullptr) {
  Building b = furnished();
  const FurnitureChanges made = alter_furniture(b, world, seed);
  if (changes != nullptr) *changes = made;
  return b;
}

/// All obstacles are apart, in a room, and the rooms are as walkable as before.
void expect_in_order(const Building& b) {
  const std::vector<Polygon2> outlines = standing(b);
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    double inside = 0.0;
    for (const Room& room : b.rooms) inside = std::max(inside, intersection_area(outlines[i], room.polygon));
    EXPECT_NEAR(inside, signed_area(outlines[i]), 1e-6) << b.obstacles[i].id;
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_LT(intersection_area(outlines[i], outlines[j]), 1e-9) << b.obstacles[i].id << " " << b.obstacles[j].id;
  }
  expect_walkable(b, standing(furnished()), outlines);
}

class AlterWorld : public testing::TestWithParam<FurnitureWorld> {};
INSTANTIATE_TEST_SUITE_P(Alter, AlterWorld,
                         testing::Values(FurnitureWorld::moved, FurnitureWorld::swapped, FurnitureWorld::more,
                                         FurnitureWorld::unknown));

TEST_P(AlterWorld, StaysWalkableAndLeavesTheRestAlone) {
  const std::map<std::string, Obstacle> before = by_id(furnished());
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    const Building b = altered(GetParam(), seed);
    expect_in_order(b);
    const std::map<std::string, Obstacle> after = by_id(b);
    ASSERT_TRUE(after.contains("site"));
    EXPECT_EQ(after.at("site").body.vertices, before.at("site").body.vertices);
    for (const auto& [id, obstacle] : after) {
      if (before.contains(id)) {
        EXPECT_EQ(obstacle.planned, before.at(id).planned) << id;
      } else {
        EXPECT_EQ(obstacle.kind, "furniture");
        EXPECT_FALSE(obstacle.planned) << id;
      }
    }
  }
}

TEST_P(AlterWorld, TheSameSeedGivesTheSameBuilding) {
  EXPECT_EQ(altered(GetParam(), 7).hash(), altered(GetParam(), 7).hash());
  EXPECT_NE(altered(GetParam(), 7).hash(), altered(GetParam(), 8).hash());
  EXPECT_NE(altered(GetParam(), 7).hash(), furnished().hash());
}

TEST(Alter, AsPlannedChangesNothing) { EXPECT_EQ(altered(FurnitureWorld::as_planned, 1).hash(), furnished().hash()); }

TEST(Alter, MovedPiecesKeepTheirShapeAndStayNear) {
  const std::map<std::string, Obstacle> before = by_id(furnished());
  FurnitureChanges changes;
  const Building b = altered(FurnitureWorld::moved, 1, &changes);
  ASSERT_EQ(b.obstacles.size(), before.size());
  int moved = 0;
  for (const Obstacle& obstacle : b.obstacles) {
    const std::vector<Eigen::Vector3d>&now = obstacle.body.vertices, &was = before.at(obstacle.id).body.vertices;
    ASSERT_EQ(now.size(), was.size());
    if (now == was) continue;
    ++moved;
    Eigen::Vector3d low = was[0], high = was[0];
    for (const Eigen::Vector3d& p : was) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    // The middle of its box turns about itself.
    const Eigen::Vector2d x_was = (was[1] - was[0]).head<2>(), x_now = (now[1] - now[0]).head<2>();
    const double yaw = std::atan2(x_was.x() * x_now.y() - x_was.y() * x_now.x(), x_was.dot(x_now));
    EXPECT_LE(std::abs(yaw), 20.0 * std::numbers::pi / 180.0 + 1e-9) << obstacle.id;
    const Eigen::Vector3d middle = 0.5 * (low + high);
    const Eigen::Vector3d from_first = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * (middle - was[0]);
    EXPECT_LE((now[0] + from_first - middle).norm(), 0.5 + 1e-9) << obstacle.id;
    for (std::size_t i = 1; i < now.size(); ++i) {
      EXPECT_NEAR((now[i] - now[0]).norm(), (was[i] - was[0]).norm(), 1e-9);
      EXPECT_EQ(now[i].z(), was[i].z());
    }
  }
  EXPECT_EQ(moved, changes.moved);
  EXPECT_GT(2 * moved, static_cast<int>(before.size()));
  EXPECT_EQ(changes.gone + changes.swapped + changes.added, 0);
}

TEST(Alter, SwappedChangesAThird) {
  const std::size_t pieces = furnished().obstacles.size() - 1;  // but for the site's own
  FurnitureChanges changes;
  const Building b = altered(FurnitureWorld::swapped, 1, &changes);
  EXPECT_EQ(changes.gone + changes.swapped, static_cast<int>((pieces + 1) / 3));
  EXPECT_GT(changes.gone, 0);
  EXPECT_GT(changes.swapped, 0);
  EXPECT_EQ(b.obstacles.size(), pieces + 1 - static_cast<std::size_t>(changes.gone));
}

TEST(Alter, MoreAddsUpToAsManyAgain) {
  const std::size_t before = furnished().obstacles.size();
  FurnitureChanges changes;
  const Building b = altered(FurnitureWorld::more, 1, &changes);
  EXPECT_EQ(b.obstacles.size(), before + static_cast<std::size_t>(changes.added));
  EXPECT_GT(2 * changes.added, static_cast<int>(before));
  EXPECT_LE(changes.added, static_cast<int>(before) - 1);
}

TEST(Alter, UnknownLeavesNothingPlannedAndCoversAsMuch) {
  const auto covered = [](const Building& b) {
    double area = 0.0;
    for (const Obstacle& obstacle : b.obstacles)
      if (obstacle.id != "site") area += signed_area(hull_of(obstacle));
    return area;
  };
  FurnitureChanges changes;
  const Building b = altered(FurnitureWorld::unknown, 1, &changes);
  for (const Obstacle& obstacle : b.obstacles) EXPECT_FALSE(obstacle.planned) << obstacle.id;
  EXPECT_EQ(changes.gone, static_cast<int>(furnished().obstacles.size()) - 1);
  EXPECT_EQ(b.obstacles.size(), static_cast<std::size_t>(changes.added) + 1);
  EXPECT_NEAR(covered(b) / covered(furnished()), 1.0, 0.1);
}

TEST(Alter, WorksWithSolidsOfAnyKindAndWithoutRooms) {
  Building b = furnished();
  b.obstacles.resize(1);
  // A tetrahedron, as a model may hold.
  b.obstacles[0].body = {{{8, 2, 1}, {9, 2, 1}, {8, 3, 1}, {8, 2, 2}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
  b.obstacles[0].kind = "proxy";
  for (const FurnitureWorld world :
       {FurnitureWorld::moved, FurnitureWorld::swapped, FurnitureWorld::more, FurnitureWorld::unknown}) {
    Building one = b, none = b;
    none.rooms.clear();
    (void)alter_furniture(one, world, 3);
    const FurnitureChanges changes = alter_furniture(none, world, 3);
    EXPECT_EQ(changes.moved + changes.swapped + changes.added, 0);
  }
  Building one = b;
  EXPECT_EQ(alter_furniture(one, FurnitureWorld::moved, 3).moved, 1);
}

}  // namespace
}  // namespace plumbline::bim
