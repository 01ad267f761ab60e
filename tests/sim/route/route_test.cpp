// SPDX-License-Identifier: Apache-2.0
#include "sim/route/route.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bim/random/stream.h"
#include "tests/sim/route/floor_plan.h"

namespace plumbline::sim {
namespace {

const Eigen::Vector2d west(2.0, 2.5);
const Eigen::Vector2d east(6.0, 2.5);

/// Least distance of a path to the walls (with their doors cut out), columns and obstacles of two_rooms and the like:
/// sampled every 5 mm, against the rectangles themselves.
double least_clearance(const std::vector<Eigen::Vector2d>& path, const std::vector<Polygon2>& solids) {
  double least = 1e9;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const int count = 1 + static_cast<int>((path[i] - path[i - 1]).norm() / 0.005);
    for (int k = 0; k <= count; ++k) {
      const Eigen::Vector2d p = path[i - 1] + (path[i] - path[i - 1]) * (static_cast<double>(k) / count);
      for (const Polygon2& solid : solids)
        least = std::min(least, contains(solid, p) ? 0.0 : boundary_distance(solid, p));
    }
  }
  return least;
}

/// The wall at x = 4 with an opening from y0 to y1, and the walls around.
std::vector<Polygon2> solids_of_two_rooms(double y0, double y1) {
  return {rectangle({3.9, 0}, {4.1, y0}),     rectangle({3.9, y1}, {4.1, 5}),   rectangle({-0.1, -0.1}, {8.1, 0.1}),
          rectangle({-0.1, 4.9}, {8.1, 5.1}), rectangle({-0.1, 0}, {0.1, 5.0}), rectangle({7.9, 0}, {8.1, 5.0})};
}

TEST(ClearanceMap, WalksThroughTheMiddleOfADoor) {
  bim::Building building = two_rooms();
  add_door(building, 0, 1.2, 1.0);
  const ClearanceMap space(building, 0);
  const std::vector<Eigen::Vector2d> path = space.path(west, east);
  ASSERT_GE(path.size(), 3U);
  EXPECT_LE(path.size(), 6U);
  EXPECT_EQ(path.front(), west);
  EXPECT_EQ(path.back(), east);
  // Half a cell of planning and half a cell of bilinear clearance.
  EXPECT_GE(least_clearance(path, solids_of_two_rooms(0.7, 1.7)), 0.40 - 0.05);
  for (std::size_t i = 1; i < path.size(); ++i) {
    if ((path[i - 1].x() < 4.0) == (path[i].x() < 4.0)) continue;
    const double s = (4.0 - path[i - 1].x()) / (path[i].x() - path[i - 1].x());
    EXPECT_NEAR(path[i - 1].y() + s * (path[i].y() - path[i - 1].y()), 1.2, 0.06);
  }
}

TEST(ClearanceMap, StraightLineStaysOneLeg) {
  const ClearanceMap space(two_rooms(), 0);
  EXPECT_EQ(space.path({1.0, 1.0}, {3.0, 4.0}).size(), 2U);
  EXPECT_EQ(space.path(west, west).size(), 2U);
}

TEST(ClearanceMap, OnlyPassableOpeningsArePassed) {
  const auto reached = [](auto&& change) {
    bim::Building building = two_rooms();
    change(add_door(building, 0, 2.5, 1.0));
    return !ClearanceMap(building, 0).path(west, east).empty();
  };
  using bim::Leaf;
  using bim::OpeningKind;
  EXPECT_TRUE(reached([](bim::Opening&) {}));
  EXPECT_TRUE(reached([](bim::Opening& o) { o.leaf = Leaf::none; }));
  EXPECT_FALSE(reached([](bim::Opening& o) { o.leaf = Leaf::closed; }));
  EXPECT_FALSE(reached([](bim::Opening& o) { o.kind = OpeningKind::window; }));
  EXPECT_TRUE(reached([](bim::Opening& o) { o.kind = OpeningKind::opening_void; }));
  EXPECT_TRUE(reached([](bim::Opening& o) { o.z0_m = 0.04; }));
  EXPECT_FALSE(reached([](bim::Opening& o) { o.z0_m = 0.10; }));
  EXPECT_FALSE(reached([](bim::Opening& o) { o.z1_m = 1.1; }));
  EXPECT_FALSE(reached([](bim::Opening& o) { o.width_m = 0.6; }));
}

TEST(ClearanceMap, DoorsAsWideAsTheRobotArePassedWhereverTheyLieOnTheGrid) {
  const Stream stream(1, "bim.generate");
  for (std::uint64_t i = 0; i < 40; ++i) {
    bim::Building building = two_rooms();
    const double s = 0.8 + 3.4 * stream.uniform(i);
    add_door(building, 0, s, 0.70);
    const std::vector<Eigen::Vector2d> path = ClearanceMap(building, 0).path(west, east);
    ASSERT_FALSE(path.empty()) << "door at " << s;
    EXPECT_GE(least_clearance(path, solids_of_two_rooms(s - 0.35, s + 0.35)), 0.35 - 0.05);
  }
}

TEST(ClearanceMap, ClearanceIsTheDistanceToTheNearestSolid) {
  bim::Building building = two_rooms();
  add_door(building, 0, 3.0, 1.0);
  const Polygon2 turned = {{1.0, 1.0}, {1.6, 1.3}, {1.4, 1.7}, {0.8, 1.4}};
  add_obstacle(building, turned, 0.0, 0.8);
  bim::Column column;
  column.storey = 0;
  column.footprint = rectangle({6.3, 1.2}, {6.7, 1.6});
  building.columns.push_back(column);
  std::vector<Polygon2> solids = solids_of_two_rooms(2.5, 3.5);
  solids.push_back(turned);
  solids.push_back(column.footprint);
  const ClearanceMap space(building, 0);
  const Stream stream(2, "bim.generate");
  for (std::uint64_t i = 0; i < 4000; ++i) {
    const Eigen::Vector2d p(0.1 + 7.8 * stream.uniform(i, 0), 0.1 + 4.8 * stream.uniform(i, 1));
    double expected = 1e9;
    for (const Polygon2& solid : solids)
      expected = std::min(expected, contains(solid, p) ? 0.0 : boundary_distance(solid, p));
    // Bilinear between exact values at most 0.035 m away, at an edge of a solid at worst.
    EXPECT_NEAR(space.clearance(p), expected, 0.035) << p.transpose();
  }
  EXPECT_EQ(space.clearance({100.0, 0.0}), 0.0);
  EXPECT_FALSE(space.free({4.0, 1.0}));
}

TEST(ClearanceMap, OnlyWhatIsAtTheRobotsHeightIsInTheWay) {
  const auto free_at = [](double z0, double z1) {
    bim::Building building = two_rooms(6.0);
    add_obstacle(building, rectangle({1.5, 2.0}, {2.5, 3.0}), 6.0 + z0, 6.0 + z1);
    return ClearanceMap(building, 0).free(west);
  };
  EXPECT_TRUE(free_at(0.0, 0.04));
  EXPECT_FALSE(free_at(0.0, 0.06));
  EXPECT_FALSE(free_at(0.3, 0.5));
  EXPECT_FALSE(free_at(0.9, 2.0));
  EXPECT_TRUE(free_at(1.1, 2.0));
  EXPECT_TRUE(free_at(-2.0, -0.5));
}

TEST(ClearanceMap, BigSolidsAreNotFreeInside) {
  bim::Building building = two_rooms();
  add_obstacle(building, rectangle({0.8, 1.0}, {3.2, 4.0}), 0.0, 2.0);
  const ClearanceMap space(building, 0);
  EXPECT_EQ(space.clearance(west), 0.0);
  EXPECT_TRUE(space.path(west, {0.5, 2.5}).empty());
}

TEST(ClearanceMap, NobodyStandsInsideHollowFurniture) {
  for (const bool open : {false, true}) {
    bim::Building building = two_rooms();
    add_obstacle(building, rectangle({1.0, 1.5}, {3.0, 3.5}), 0.0, 2.0);
    bim::Solid& cupboard = building.obstacles.back().body;
    // Without its underside it has no inside; without a door's side one walks in.
    std::erase_if(cupboard.triangles, [&](const Eigen::Vector3i& t) {
      Eigen::Vector3d middle = Eigen::Vector3d::Zero();
      for (const int k : t) middle += cupboard.vertices[static_cast<std::size_t>(k)] / 3.0;
      return middle.z() == 0.0 || (open && middle.x() == 3.0);
    });
    const ClearanceMap space(building, 0);
    EXPECT_EQ(space.clearance(west) > 0.5, open);
    EXPECT_EQ(space.path({3.45, 2.5}, west).empty(), !open);
    EXPECT_TRUE(space.free(east));
  }
  // A shell as large as a room is one, with or without a way in.
  bim::Building building = two_rooms();
  add_obstacle(building, rectangle({4.2, 0.2}, {7.8, 4.8}), 0.0, 2.0);
  std::erase_if(building.obstacles.back().body.triangles, [&](const Eigen::Vector3i& t) {
    const auto& v = building.obstacles.back().body.vertices;
    return std::ranges::all_of(std::vector<int>{t[0], t[1], t[2]},
                               [&](int k) { return v[static_cast<std::size_t>(k)].z() == 0.0; });
  });
  EXPECT_TRUE(ClearanceMap(building, 0).free(east));
}

TEST(ClearanceMap, HolesInTheFloorAreWalkedAround) {
  bim::Building building = two_rooms();
  building.slabs[0].polygon.holes.push_back({{1.5, 1.5}, {1.5, 3.5}, {2.5, 3.5}, {2.5, 1.5}});
  const ClearanceMap space(building, 0);
  EXPECT_FALSE(space.free(west));
  const std::vector<Eigen::Vector2d> path = space.path({0.8, 2.5}, {3.2, 2.5});
  ASSERT_GE(path.size(), 3U);
  EXPECT_GE(least_clearance(path, {rectangle({1.5, 1.5}, {2.5, 3.5})}), 0.40 - 0.05);
}

TEST(ClearanceMap, GapsBetweenSlabsUnderADoorAreSteppedOver) {
  bim::Building building = two_rooms();
  add_door(building, 0, 2.5, 1.0);
  building.slabs[0].polygon.outer = rectangle({0.0, 0.0}, {3.8, 5.0});
  building.slabs.push_back(building.slabs[0]);
  building.slabs[1].polygon.outer = rectangle({4.2, 0.0}, {8.0, 5.0});
  EXPECT_FALSE(ClearanceMap(building, 0).path(west, east).empty());
  building.slabs[1].polygon.outer = rectangle({5.0, 0.0}, {8.0, 5.0});
  EXPECT_TRUE(ClearanceMap(building, 0).path(west, east).empty());
}

TEST(ClearanceMap, WallsWithABodyAreAsGoodAsBoxes) {
  bim::Building boxes = two_rooms();
  add_door(boxes, 0, 1.7, 0.9);
  bim::Building bodies = boxes;
  for (bim::Wall& wall : bodies.walls) {
    const Eigen::Vector2d near = wall.offset_m * wall.left();
    const Eigen::Vector2d far = (wall.offset_m + wall.thickness_m) * wall.left();
    wall.body = prism({wall.a + near, wall.b + near, wall.b + far, wall.a + far}, 0.0, 3.0);
  }
  const ClearanceMap a(boxes, 0);
  const ClearanceMap b(bodies, 0);
  const Stream stream(3, "bim.generate");
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const Eigen::Vector2d p(8.0 * stream.uniform(i, 0), 5.0 * stream.uniform(i, 1));
    EXPECT_NEAR(a.clearance(p), b.clearance(p), 1e-12) << p.transpose();
  }
  EXPECT_EQ(a.path(west, east), b.path(west, east));
}

/// One wall all round a room, with a door in its south side.
bim::Building ring_with_door() {
  bim::Building building = empty_storey();
  bim::Wall& wall = building.walls[static_cast<std::size_t>(add_wall(building, {0, 0}, {4, 0}))];
  bim::Solid body;
  for (const Polygon2& side : {rectangle({0, 0}, {4, 0.2}), rectangle({0, 3.8}, {4, 4}),
                               rectangle({0, 0.201}, {0.2, 3.799}), rectangle({3.8, 0.201}, {4, 3.799})}) {
    const bim::Solid part = prism(side, 0.0, 3.0);
    const int first = static_cast<int>(body.vertices.size());
    body.vertices.insert(body.vertices.end(), part.vertices.begin(), part.vertices.end());
    for (const Eigen::Vector3i& t : part.triangles) body.triangles.emplace_back(t.array() + first);
  }
  wall.body = body;
  wall.offset_m = 0.0;
  wall.thickness_m = 4.0;
  add_door(building, 0, 2.0, 1.0).solid = prism(rectangle({1.5, -0.1}, {2.5, 0.3}), 0.0, 2.1);
  bim::Slab slab;
  slab.id = "slab";
  slab.storey = 0;
  slab.polygon.outer = rectangle({-4, -4}, {8, 8});
  slab.z0_m = -0.2;
  building.slabs.push_back(slab);
  add_room(building, "yard", slab.polygon.outer);
  return building;
}

TEST(ClearanceMap, ADoorInAWallThatGoesRoundOpensNoSideOpposite) {
  const bim::Building building = ring_with_door();
  const ClearanceMap space(building, 0);
  EXPECT_GT(space.clearance({2.0, 0.1}), 0.4);
  EXPECT_EQ(space.clearance({2.0, 3.9}), 0.0);
  const std::vector<Eigen::Vector2d> path = space.path({2.0, 2.0}, {2.0, 6.0});
  ASSERT_FALSE(path.empty());
  double lowest = 2.0;
  for (const Eigen::Vector2d& p : path) lowest = std::min(lowest, p.y());
  EXPECT_LT(lowest, 0.0) << "not through the door";
}

TEST(ClearanceMap, TargetOfARoomIsItsFreestPoint) {
  bim::Building building = two_rooms();
  const ClearanceMap space(building, 0);
  const auto target = space.room_targets(building.rooms[0]);
  ASSERT_EQ(target.size(), 1U);
  EXPECT_TRUE(contains(building.rooms[0].polygon, target[0]));
  EXPECT_NEAR(space.clearance(target[0]), 1.9, 0.03);
  add_obstacle(building, rectangle({0.0, 0.0}, {4.0, 5.0}), 0.0, 1.0);
  EXPECT_TRUE(ClearanceMap(building, 0).room_targets(building.rooms[0]).empty());
}

TEST(ClearanceMap, TargetsOfRoomsWithoutWallsBetweenThemLieWellInside) {
  bim::Building building = empty_storey();
  add_room(building, "west", rectangle({0.0, 0.0}, {4.0, 4.0}));
  add_room(building, "east", rectangle({4.0, 0.0}, {8.0, 4.0}));
  add_room(building, "strip", rectangle({0.0, 4.0}, {8.0, 4.8}));
  add_room(building, "north", rectangle({0.0, 4.8}, {8.0, 8.8}));
  const ClearanceMap space(building, 0);
  for (const bim::Room& room : building.rooms) {
    const std::vector<Eigen::Vector2d> targets = space.room_targets(room);
    ASSERT_EQ(targets.size(), 1U) << room.id;
    EXPECT_TRUE(room.contains(targets[0]));
    EXPECT_GT(room.boundary_distance(targets[0]), room.id == "strip" ? 0.2 : 0.5 - 1e-9) << room.id;
  }
}

TEST(ClearanceMap, APlaceWellInsideIsNotTakenWhereItIsTight) {
  bim::Building building = empty_storey();
  add_room(building, "hall", rectangle({0.0, 0.0}, {8.0, 4.0}));
  add_room(building, "nook", rectangle({2.0, 4.0}, {4.0, 5.2}));
  add_wall(building, {0.0, 5.3}, {8.0, 5.3});
  const ClearanceMap space(building, 0);
  const std::vector<Eigen::Vector2d> targets = space.room_targets(building.rooms[1]);
  ASSERT_EQ(targets.size(), 1U);
  EXPECT_LT(building.rooms[1].boundary_distance(targets[0]), 0.1);
}

TEST(ClearanceMap, TheOpenEndOfARoomWithWallsIsAsGoodAPlaceAsAnyInIt) {
  bim::Building building = empty_storey();
  add_room(building, "hall", rectangle({0.0, 0.0}, {8.0, 4.0}));
  add_room(building, "aisle", rectangle({3.0, 4.0}, {5.0, 8.0}));
  building.rooms[1].walls = {add_wall(building, {2.9, 4.0}, {2.9, 8.0}), add_wall(building, {5.1, 4.0}, {5.1, 8.0})};
  const ClearanceMap space(building, 0);
  const std::vector<Eigen::Vector2d> targets = space.room_targets(building.rooms[1]);
  ASSERT_EQ(targets.size(), 1U);
  EXPECT_LT(building.rooms[1].boundary_distance(targets[0]), 0.1);
}

TEST(ClearanceMap, ARoomInWhichTheRobotCannotTurnIsNoTarget) {
  const bim::Building building = two_rooms();
  const bim::Room room = building.rooms[0];
  // Two boxes leave a lane along the middle of the room, which is walked through but not turned in.
  for (const double lane : {0.95, 1.2}) {
    bim::Building filled = building;
    add_obstacle(filled, rectangle({0.0, 0.0}, {4.0, 2.5 - 0.5 * lane}), 0.0, 1.0);
    add_obstacle(filled, rectangle({0.0, 2.5 + 0.5 * lane}, {4.0, 5.0}), 0.0, 1.0);
    const ClearanceMap space(filled, 0);
    EXPECT_TRUE(space.free({2.0, 2.5})) << lane;
    EXPECT_EQ(space.room_targets(room).empty(), lane < 1.1) << lane;
  }
}

TEST(ClearanceMap, OpenTargetIsTheFreestPointOfTheLargestPieceOfFloor) {
  bim::Building building = two_rooms();
  // The west room has the freest place, the east one, with a pillar in it, more floor.
  add_obstacle(building, rectangle({0.0, 0.0}, {4.0, 1.2}), 0.0, 1.0);
  add_obstacle(building, rectangle({5.8, 2.3}, {6.2, 2.7}), 0.0, 1.0);
  const ClearanceMap space(building, 0);
  const auto in_west = space.room_targets(building.rooms[0]);
  const auto target = space.open_target();
  ASSERT_EQ(in_west.size(), 1U);
  ASSERT_EQ(target, space.room_targets(building.rooms[1]));
  EXPECT_GT(space.clearance(in_west[0]), space.clearance(target[0]));
  add_obstacle(building, rectangle({0.0, 0.0}, {8.0, 5.0}), 0.0, 1.0);
  EXPECT_TRUE(ClearanceMap(building, 0).open_target().empty());
}

TEST(ClearanceMap, UnreachableOrOccupiedEndsGiveNoPath) {
  const ClearanceMap space(two_rooms(), 0);
  EXPECT_TRUE(space.path(west, east).empty());
  EXPECT_TRUE(space.path(west, {4.0, 2.5}).empty());
  EXPECT_TRUE(space.path({0.2, 2.5}, west).empty());
  EXPECT_TRUE(space.path(west, {1000.0, 0.0}).empty());
  EXPECT_TRUE(space.path(west, {std::nan(""), 0.0}).empty());
  const Eigen::Vector2d beside(1.0, 1.0);
  EXPECT_EQ(space.reachable(west, {east, beside, {4.0, 2.5}, {1000.0, 0.0}, west}),
            (std::vector<Eigen::Vector2d>{beside, west}));
  EXPECT_TRUE(space.reachable({0.2, 2.5}, {west}).empty());
}

/// A hall of 14 x 10 m of which walls shut off the middle, and a room east of it.
bim::Building around_a_core(bool with_door) {
  bim::Building building = empty_storey();
  const auto ring = [&](const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
    const Polygon2 corners = rectangle(low, high);
    for (std::size_t i = 0; i < 4; ++i) add_wall(building, corners[i], corners[(i + 1) % 4]);
  };
  ring({0, 0}, {14, 10});
  ring({1.5, 1.5}, {12.5, 8.5});
  ring({14, 0}, {18, 10});
  for (const int wall : {1, 11})
    if (with_door) add_door(building, wall, 5.0, 1.2);
  add_room(building, "hall", rectangle({0.1, 0.1}, {13.9, 9.9}));
  add_room(building, "east", rectangle({14.1, 0.1}, {17.9, 9.9}));
  bim::Slab slab;
  slab.id = "slab";
  slab.storey = 0;
  slab.polygon.outer = rectangle({0, 0}, {18, 10});
  slab.z0_m = -0.2;
  building.slabs.push_back(slab);
  return building;
}

TEST(ClearanceMap, TheTargetOfARoomAroundAShaftLiesWhereADoorLeads) {
  const Polygon2 core = rectangle({1.5, 1.5}, {12.5, 8.5});
  for (const bool with_door : {true, false}) {
    const bim::Building building = around_a_core(with_door);
    const ClearanceMap space(building, 0);
    const std::vector<Eigen::Vector2d> targets = space.room_targets(building.rooms[0]);
    ASSERT_EQ(targets.size(), 2U);
    EXPECT_NE(contains(core, targets[0]), with_door) << "of two that nothing leads to, the larger";
    EXPECT_NE(contains(core, targets[0]), contains(core, targets[1]));
    EXPECT_EQ(space.freest_cell(building.rooms[0]), space.grid().find(targets[0]));
  }
}

}  // namespace
}  // namespace plumbline::sim
