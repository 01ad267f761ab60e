// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/walk_coverage.h"

#include <gtest/gtest.h>

#include "bim/formats/plan_yaml/plan_yaml.h"
#include "scenarios/spec/room_places.h"
#include "tests/input_error.h"
#include "tests/sim/route/floor_plan.h"

namespace plumbline::scenarios {
namespace {

/// A row of rooms of 4 x 5 m with a door of 0.9 m in each wall between two; walls first, west to east.
bim::Building row_of_rooms(int count) {
  bim::Building building = sim::empty_storey();
  for (int i = 1; i < count; ++i) sim::add_wall(building, {4.0 * i, 0.0}, {4.0 * i, 5.0});
  const double end = 4.0 * count;
  sim::add_wall(building, {0, 0}, {end, 0});
  sim::add_wall(building, {end, 0}, {end, 5});
  sim::add_wall(building, {end, 5}, {0, 5});
  sim::add_wall(building, {0, 5}, {0, 0});
  for (int i = 0; i < count; ++i)
    sim::add_room(building, "r" + std::to_string(i), sim::rectangle({4.0 * i + 0.1, 0.1}, {4.0 * i + 3.9, 4.9}));
  for (int i = 1; i < count; ++i) sim::add_door(building, i - 1, 2.5, 0.9);
  bim::Slab slab;
  slab.id = "slab";
  slab.storey = 0;
  slab.polygon.outer = sim::rectangle({-0.1, -0.1}, {end + 0.1, 5.1});
  building.slabs.push_back(slab);
  return building;
}

WalkCoverage coverage_of(const bim::Building& building, std::optional<double> longest_m = std::nullopt) {
  const sim::MultiStoreyPlanner space(building);
  return walk_coverage(space, plan_route(space, {}, {}, {}, longest_m));
}

TEST(WalkCoverage, AWalkThroughAllRoomsHasNothingToSay) {
  const WalkCoverage walk = coverage_of(row_of_rooms(4));
  EXPECT_EQ(walk.rooms, 4);
  EXPECT_EQ(walk.in_reach, 4);
  EXPECT_EQ(walk.on_route, 4);
  EXPECT_TRUE(walk.out_of_reach.empty());
  EXPECT_TRUE(walk.left_out.empty());
  EXPECT_TRUE(walk_warnings(walk).empty());
}

TEST(WalkCoverage, RoomsWithoutWallsBetweenThemAreAllEntered) {
  bim::Building building = sim::empty_storey();
  for (int i = 0; i < 5; ++i)
    for (const double y : {0.0, 6.0})
      sim::add_room(building, "r" + std::to_string(i) + (y > 0.0 ? "n" : "s"),
                    sim::rectangle({4.0 * i, y}, {4.0 * i + 4.0, y + 4.0}));
  sim::add_room(building, "corridor", sim::rectangle({0, 4}, {20, 6}));
  const WalkCoverage walk = coverage_of(building);
  EXPECT_EQ(walk.in_reach, 11);
  EXPECT_EQ(walk.on_route, 11);
  EXPECT_TRUE(left_out_lines(walk).empty());
}

TEST(WalkCoverage, RoomsThatADefaultWalkHasNoTimeForAreCounted) {
  const WalkCoverage walk = coverage_of(row_of_rooms(7), 15.0);
  ASSERT_LT(walk.on_route, 7);
  ASSERT_EQ(left_out_lines(walk).size(), 1U);
  EXPECT_EQ(left_out_lines(walk).front().rfind(
                "left out: " + std::to_string(7 - walk.on_route) + " rooms in reach, since a default walk takes", 0),
            0U);
}

TEST(WalkCoverage, AStoreyWithoutRoomsSaysWhatIsNotScored) {
  bim::Building building = row_of_rooms(2);
  building.rooms.clear();
  const std::vector<std::string> warnings = walk_warnings(coverage_of(building));
  ASSERT_FALSE(warnings.empty());
  EXPECT_EQ(warnings.front(),
            "no rooms are known on ground: the walk goes round its floor, methods that localize have nowhere to begin, "
            "and `rooms.*` are not scored");
}

TEST(WalkCoverage, RoomsBehindADoorSayWhichAndTheLargerPieceIsWalked) {
  bim::Building building = row_of_rooms(7);
  building.openings[1].width_m = 0.5;  // two rooms on this side, five beyond
  const WalkCoverage walk = coverage_of(building);
  EXPECT_EQ(walk.in_reach, 5);
  ASSERT_EQ(walk.out_of_reach.size(), 2U);
  for (const RoomOutOfReach& room : walk.out_of_reach) {
    EXPECT_EQ(room.why.rfind("door 'd1' is 0.5 m wide", 0), 0U) << room.why;
    ASSERT_EQ(room.blockages.size(), 1U);
  }
  ASSERT_EQ(out_of_reach_lines(walk, 5).size(), 1U);
  EXPECT_EQ(out_of_reach_lines(walk, 5).front().rfind("r0, r1: door 'd1'", 0), 0U);
  EXPECT_TRUE(walk_warnings(walk).empty());
}

TEST(WalkCoverage, FewRoomsInReachAreAWarningThatNamesWhatWouldHelp) {
  bim::Building building = row_of_rooms(7);
  for (const std::size_t door : {0U, 2U, 4U}) building.openings[door].leaf = bim::Leaf::closed;
  building.openings[5].leaf = bim::Leaf::closed;
  const std::vector<std::string> warnings = walk_warnings(coverage_of(building));
  ASSERT_FALSE(warnings.empty());
  EXPECT_EQ(warnings.front().rfind("the start reaches only 2 of the 7 rooms on ground: door '", 0), 0U)
      << warnings.front();
  EXPECT_NE(warnings.front().find("`doors: open`"), std::string::npos);
}

TEST(WalkCoverage, ARoomTooSmallToTurnInSaysHowMuchItNeeds) {
  bim::Building building = row_of_rooms(3);
  sim::add_obstacle(building, sim::rectangle({8.9, 0.1}, {11.9, 4.9}), 0.0, 1.0);
  const WalkCoverage walk = coverage_of(building);
  ASSERT_EQ(walk.out_of_reach.size(), 1U);
  EXPECT_NE(walk.out_of_reach.front().why.find("it needs 1.1 m"), std::string::npos) << walk.out_of_reach.front().why;
}

TEST(WalkCoverage, ARoomWithoutAFloorSaysSo) {
  bim::Building building = row_of_rooms(3);
  building.slabs.front().polygon.outer = sim::rectangle({-0.1, -0.1}, {8.0, 5.1});
  const WalkCoverage walk = coverage_of(building);
  ASSERT_EQ(walk.out_of_reach.size(), 1U);
  EXPECT_EQ(walk.out_of_reach.front().why.rfind("there is no floor in it", 0), 0U) << walk.out_of_reach.front().why;
}

TEST(WalkCoverage, AWalkThatMayNotBeLongGoesFarAndSaysWhatItLeavesOut) {
  const bim::Building building = row_of_rooms(20);
  const WalkCoverage walk = coverage_of(building, 60.0);
  EXPECT_LE(walk.planned_m, 60.0);
  EXPECT_GT(walk.planned_m, 45.0);
  EXPECT_EQ(walk.in_reach, 20);
  EXPECT_GE(walk.on_route, 6);
  EXPECT_EQ(walk.left_out.size(), static_cast<std::size_t>(walk.in_reach - walk.on_route));
}

TEST(WalkCoverage, NowhereToWalkIsRefusedWithWhatStopsTheRobot) {
  bim::Building building = row_of_rooms(2);
  building.openings.front().width_m = 0.5;
  for (const double x : {0.1, 4.1})  // room to turn, and no more
    for (const double y : {0.1, 3.1}) sim::add_obstacle(building, sim::rectangle({x, y}, {x + 3.8, y + 1.8}), 0.0, 1.0);
  for (const double x : {0.1, 5.3}) sim::add_obstacle(building, sim::rectangle({x, 1.9}, {x + 2.6, 3.1}), 0.0, 1.0);
  const std::string text = input_error([&] { (void)coverage_of(building); });
  EXPECT_NE(text.find("there is nowhere to walk to from ["), std::string::npos) << text;
  EXPECT_NE(text.find("door 'd0' is 0.5 m wide"), std::string::npos) << text;
}

/// One room with so much clear floor, on a slab.
bim::Building room_of(double length, double width) {
  bim::Building building = sim::empty_storey();
  const Polygon2 corners = sim::rectangle({0, 0}, {length + 0.2, width + 0.2});
  for (std::size_t i = 0; i < 4; ++i) sim::add_wall(building, corners[i], corners[(i + 1) % 4]);
  sim::add_room(building, "r", sim::rectangle({0.1, 0.1}, {length + 0.1, width + 0.1}));
  bim::Slab slab;
  slab.id = "slab";
  slab.storey = 0;
  slab.polygon.outer = corners;
  building.slabs.push_back(slab);
  return building;
}

TEST(WalkCoverage, ASmallRoomIsWalkedIn) {
  for (const auto& [length, width] : {std::pair{3.6, 2.6}, {2.4, 2.2}, {4.5, 4.0}}) {
    const WalkCoverage walk = coverage_of(room_of(length, width));
    EXPECT_GT(walk.planned_m, 1.5) << length;
    EXPECT_EQ(walk.on_route, 1);
  }
}

/// A gap that the robot fits into and in which it cannot turn, between a desk and two walls.
TEST(WalkCoverage, AWalkTurnsBackOnlyWhereThereIsRoom) {
  const double turn_m = sim::RouteConfig().turn_m - sim::RouteConfig().cell_m;
  bim::Building building = room_of(9.0, 5.0);
  sim::add_obstacle(building, sim::rectangle({5.0, 0.1 + 0.875}, {9.1, 1.8}), 0.0, 0.8);
  const sim::MultiStoreyPlanner space(building);
  const RoutePlan plan = plan_route(space, {}, {}, {});
  const std::vector<sim::Waypoint>& way = plan.waypoints;
  int back = 0;
  for (std::size_t i = 1; i + 1 < way.size(); ++i) {
    const Eigen::Vector2d in = (way[i].p_W - way[i - 1].p_W).head<2>(), out = (way[i + 1].p_W - way[i].p_W).head<2>();
    if (in.dot(out) > -0.7 * in.norm() * out.norm()) continue;
    ++back;
    EXPECT_GE(space.storey(0).clearance(way[i].p_W.head<2>()), turn_m) << way[i].p_W.transpose();
  }
  EXPECT_GT(back, 0);
}

TEST(WalkCoverage, AStartBesideTheFloorSaysSo) {
  bim::Building building = room_of(4.0, 4.0);
  building.rooms.clear();
  Start start;
  start.storey = building.storeys.front().id;
  start.at = Eigen::Vector2d(-0.8, 2.0);
  const std::string text = input_error([&] { (void)plan_route(sim::MultiStoreyPlanner(building), start, {}, {}); });
  EXPECT_NE(text.find("is not on the floor"), std::string::npos) << text;
}

/// Walls along one side only, and a roof over the floor.
TEST(WalkCoverage, AFloorBesideOneWallIsWalkedUnderItsRoof) {
  bim::Building building = sim::empty_storey();
  sim::add_wall(building, {0, 0}, {8, 0});
  bim::Slab roof;
  roof.id = "roof";
  roof.storey = 0;
  roof.polygon.outer = sim::rectangle({0, 0}, {8, 5});
  roof.z0_m = 3.0;
  roof.z1_m = 3.2;
  building.slabs.push_back(roof);
  const RoutePlan plan = plan_route(sim::MultiStoreyPlanner(building), {}, {}, {});
  EXPECT_GT(plan.length_m, 5.0);
  for (const sim::Waypoint& waypoint : plan.waypoints)
    EXPECT_TRUE(contains(roof.polygon.outer, waypoint.p_W.head<2>())) << waypoint.p_W.transpose();
}

TEST(WalkCoverage, AStoreyOutOfReachOfAWalkOfAllIsNamed) {
  bim::Building building = row_of_rooms(3);
  building.storeys.push_back({"upper", "upper", 3.0, 3.0, 0});
  Route route;
  route.storeys = RouteStoreys::all;
  const auto warnings = [&] {
    const sim::MultiStoreyPlanner space(building);
    return walk_warnings(walk_coverage(space, plan_route(space, {}, route, {})));
  };
  ASSERT_EQ(warnings().size(), 1U);
  EXPECT_EQ(warnings().front(), "`storeys: all` leaves out upper (0 rooms): the building has no stairs");
  sim::add_obstacle(building, sim::rectangle({20, 20}, {21, 21}), 0.0, 1.0);
  building.obstacles.back().kind = "ramp";
  EXPECT_NE(warnings().front().find("has ramps and no stairs"), std::string::npos) << warnings().front();
}

TEST(WalkCoverage, APartOfARoomOutOfReachIsSaid) {
  bim::Building building = row_of_rooms(3);
  sim::add_obstacle(building, sim::rectangle({10.5, 0.0}, {10.7, 5.0}), 0.0, 1.0);
  const WalkCoverage walk = coverage_of(building);
  ASSERT_EQ(walk.in_part.size(), 1U);
  EXPECT_EQ(walk.in_part.front().name, "r2");
  EXPECT_GT(walk.in_part.front().share, 0.1);
  ASSERT_FALSE(walk_warnings(walk).empty());
  EXPECT_NE(walk_warnings(walk).front().find("% of the floor of r2"), std::string::npos);
}

// Two halves without a door between them, each with a stair to the one room above.
TEST(WalkCoverage, ARoomBehindTwoStairsIsNoFloorOutOfReach) {
  std::string text = "plan: 1\nname: halves\nstoreys:\n";
  text += "  - {id: ground, elevation_m: 0, height_m: 2.7}\n  - {id: upper, elevation_m: 3, height_m: 2.7}\nwalls:\n";
  const auto wall = [&](const std::string& storey, const std::string& a, const std::string& b) {
    text += "  - {id: " + storey + a.substr(1, 1) + a.substr(4, 1) + b.substr(1, 1) + ", storey: " + storey +
            ", a: " + a + ", b: " + b + ", thickness_m: 0.2, just: right}\n";
  };
  for (const std::string storey : {"ground", "upper"}) {
    wall(storey, "[0, 0]", "[9, 0]");
    wall(storey, "[9, 0]", "[9, 8]");
    wall(storey, "[9, 8]", "[0, 8]");
    wall(storey, "[0, 8]", "[0, 0]");
  }
  wall("ground", "[0, 4]", "[9, 4]");
  text += "rooms:\n  - {id: south, storey: ground, polygon: [[0, 0], [9, 0], [9, 3.8], [0, 3.8]]}\n";
  text += "  - {id: north, storey: ground, polygon: [[0, 4], [9, 4], [9, 8], [0, 8]]}\n";
  text += "  - {id: above, storey: upper, polygon: [[0, 0], [9, 0], [9, 8], [0, 8]]}\nstairs:\n";
  for (const std::string y : {"1", "7"})
    text += "  - {id: stair" + y + ", from: ground, to: upper, start: [2, " + y +
            "], width_m: 1.0, rise_m: 0.18, run_m: 0.27}\n";
  const bim::Building building = bim::read_plan_text(text, "halves.plan.yaml");
  const sim::MultiStoreyPlanner space(building);
  Start start;
  start.room = "south";
  const WalkCoverage walk = walk_coverage(space, plan_route(space, start, {}, {}));
  EXPECT_EQ(walk.in_reach, 2);
  EXPECT_TRUE(walk.in_part.empty());
  for (const std::string& warning : walk_warnings(walk))
    EXPECT_EQ(warning.find("out of reach"), std::string::npos) << warning;
  EXPECT_EQ(walk.elsewhere, 1);
  EXPECT_NE(walk_sentence(walk).find("2 of the 2 rooms on ground, and 1 room of other storeys"), std::string::npos)
      << walk_sentence(walk);
}

TEST(RoomPlaces, ABasementOfOneRoomIsNoStartWhereAStoreyAboveHasMore) {
  bim::Building building = row_of_rooms(3);
  building.storeys.push_back({"cellar", "cellar", -3.0, 3.0, 0});
  sim::add_room(building, "cellar", sim::rectangle({0.1, 0.1}, {3.9, 4.9}));
  building.rooms.back().storey = 1;
  bim::Slab slab = building.slabs.front();
  slab.storey = 1;
  slab.z0_m = -3.2;
  slab.z1_m = -3.0;
  building.slabs.push_back(slab);
  const sim::MultiStoreyPlanner space(building);
  EXPECT_EQ(RoomPlaces(building, space).start_storey(), 0);
  EXPECT_EQ(RoomPlaces(building, space).start_on(1).rooms, 1);
  bim::Building alone = building;
  for (bim::Opening& door : alone.openings) door.leaf = bim::Leaf::closed;
  const sim::MultiStoreyPlanner shut(alone);
  EXPECT_EQ(RoomPlaces(alone, shut).start_storey(), 1);
}

/// Two rooms side by side on one slab with walls around both and none between them.
bim::Building open_rooms(double length, double width) {
  bim::Building building = room_of(length, 2.0 * width);
  building.rooms.clear();
  for (int i = 0; i < 2; ++i)
    sim::add_room(building, "r" + std::to_string(i),
                  sim::rectangle({0.1, 0.1 + width * i}, {length + 0.1, 0.1 + width * (i + 1)}));
  return building;
}

TEST(WalkCoverage, ARoomIsEnteredWhereTheRobotIsWellInside) {
  const bim::Building building = open_rooms(6.0, 3.0);
  const sim::MultiStoreyPlanner space(building);
  RoutePlan along;
  along.storey = 0;
  along.start_W = {1.0, 3.2};
  along.waypoints = {{{1.0, 3.2, 0.0}}, {{5.0, 3.2, 0.0}}};
  EXPECT_EQ(walk_coverage(space, along).on_route, 0) << "a walk along the edge that they share";
  along.waypoints.push_back({{5.0, 4.0, 0.0}});
  EXPECT_EQ(walk_coverage(space, along).on_route, 1);
  EXPECT_EQ(coverage_of(building).on_route, 2);
}

// A kitchen with walls on three sides: its freest place lies where it is open to the room before it.
TEST(WalkCoverage, ARoomWithAnOpenSideIsEntered) {
  bim::Building building = row_of_rooms(1);
  building.rooms.clear();
  sim::add_room(building, "living", sim::rectangle({0.1, 0.1}, {3.9, 3.2}));
  sim::add_room(building, "kitchen", sim::rectangle({0.1, 3.2}, {3.9, 4.9}));
  for (bim::Room& room : building.rooms) room.walls = {0};
  const sim::MultiStoreyPlanner space(building);
  EXPECT_NEAR(space.storey(0).room_targets(building.rooms[1]).front().y(), 3.2, 0.06);
  const WalkCoverage walk = walk_coverage(space, plan_route(space, {}, {}, {}));
  EXPECT_EQ(walk.on_route, 2);
  EXPECT_TRUE(left_out_lines(walk).empty());
}

// In rooms this narrow the places to turn round lie so near to each other that to go through both is no walk.
TEST(WalkCoverage, AWalkOfLessThanAMetreIsNone) {
  EXPECT_GT(coverage_of(open_rooms(6.0, 0.65)).planned_m, 8.0);
  const std::string text = input_error([] { (void)coverage_of(open_rooms(1.4, 0.65)); });
  EXPECT_NE(text.find("there is nowhere to walk to from ["), std::string::npos) << text;
}

}  // namespace
}  // namespace plumbline::scenarios
