// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/route_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/load/load.h"
#include "bim/model/extrude.h"
#include "scenarios/spec/named_places.h"
#include "tests/data.h"
#include "tests/input_error.h"

namespace plumbline::scenarios {
namespace {

using Names = std::vector<std::string>;

bim::Building house() { return bim::load_building(project_file("scenarios/library/house.plan.yaml")); }

Start in(const std::string& room) {
  Start start;
  start.room = room;
  return start;
}

Start at(const std::string& storey, double x, double y) {
  Start start;
  start.storey = storey;
  start.at = Eigen::Vector2d(x, y);
  return start;
}

Route through(const Names& rooms, int loop = 1) {
  Route route;
  route.rooms = rooms;
  route.loop = loop;
  return route;
}

std::string error_of(const bim::Building& building, const Start& start, const Route& route) {
  return input_error([&] { (void)plan_route(building, start, route, {}); });
}

int climbs(const RoutePlan& plan, double sign) {
  int count = 0;
  for (std::size_t i = 1; i < plan.waypoints.size(); ++i) {
    const bool begins = plan.waypoints[i].stairs && !plan.waypoints[i - 1].stairs;
    if (begins && sign * (plan.waypoints[i].p_W.z() - plan.waypoints[i - 1].p_W.z()) > 0.0) ++count;
  }
  return count;
}

TEST(RoutePlan, NamedRoomsMayLieOnOtherStoreys) {
  const RoutePlan plan = plan_route(house(), in("living"), through({"study", "kitchen"}), {});
  EXPECT_EQ(plan.storey, 0);
  EXPECT_EQ(climbs(plan, 1.0), 1);
  EXPECT_EQ(climbs(plan, -1.0), 1);
  EXPECT_EQ(plan.waypoints.back().p_W.z(), 0.0);
  EXPECT_GT(plan.stairs_m, 10.0);
  EXPECT_LT(plan.stairs_m, plan.length_m);
}

TEST(RoutePlan, StartsOnAnyStorey) {
  const RoutePlan plan = plan_route(house(), in("study"), through({"gallery", "hall"}), {});
  EXPECT_EQ(plan.storey, 1);
  EXPECT_EQ(plan.waypoints.front().p_W.z(), 2.9);
  EXPECT_EQ(plan.waypoints.back().p_W.z(), 0.0);
  EXPECT_EQ(climbs(plan, -1.0), 1);
}

TEST(RoutePlan, AllRoomsAreThoseOfTheStoreyUnlessAsked) {
  Route route;
  EXPECT_EQ(climbs(plan_route(house(), in("living"), route, {}), 1.0), 0);
  route.storeys = RouteStoreys::all;
  const RoutePlan plan = plan_route(house(), in("living"), route, {});
  Names rooms = plan.rooms;
  EXPECT_EQ(rooms.back(), "living");
  std::sort(rooms.begin(), rooms.end());
  EXPECT_EQ(rooms, (Names{"bath", "gallery", "hall", "kitchen", "living", "north_bedroom", "south_bedroom", "study",
                          "upper_bath"}));
  EXPECT_EQ(climbs(plan, 1.0), 1);
  EXPECT_EQ(climbs(plan, -1.0), 1);
}

TEST(RoutePlan, AStartOnTheMapIsToldWhereItLiesInTheMovedBuilding) {
  bim::Building building = house();
  building.moved_by = Eigen::Vector3d(-691000.0, -5334000.0, 0.0);
  const std::string error = error_of(building, at("ground", 691002.0, 5334003.0), {});
  EXPECT_NE(error.find("outside every room"), std::string::npos) << error;
  EXPECT_NE(error.find("on the map's [691002, 5334003] lies [2, 3]"), std::string::npos) << error;
  EXPECT_EQ(error_of(building, at("ground", -30.0, 2.0), {}).find("map"), std::string::npos);
}

TEST(RoutePlan, ARouteOfAllIsTheRouteOfItsNames) {
  Route route;
  route.storeys = RouteStoreys::all;
  route.loop = 2;
  const RoutePlan plan = plan_route(house(), in("living"), route, {});
  const RoutePlan again = plan_route(house(), in("living"), through(plan.rooms, 2), {});
  ASSERT_EQ(plan.waypoints.size(), again.waypoints.size());
  for (std::size_t i = 0; i < plan.waypoints.size(); ++i) EXPECT_EQ(plan.waypoints[i].p_W, again.waypoints[i].p_W);
}

TEST(RoutePlan, TheOnlyRoomInReachIsWalkedRound) {
  bim::Building alone = house();
  alone.rooms = {alone.rooms[static_cast<std::size_t>(find_room(alone, "living", {}))]};
  const RoutePlan plan = plan_route(alone, in("living"), Route{}, {});
  EXPECT_EQ(plan.rooms, Names{"all"});
  EXPECT_GT(plan.length_m, 10.0);
  EXPECT_EQ(plan.waypoints.back().p_W, plan.waypoints.front().p_W);
  const RoutePlan again = plan_route(alone, at("ground", plan.start_W.x(), plan.start_W.y()), through(plan.rooms), {});
  ASSERT_EQ(plan.waypoints.size(), again.waypoints.size());
  for (std::size_t i = 0; i < plan.waypoints.size(); ++i) EXPECT_EQ(plan.waypoints[i].p_W, again.waypoints[i].p_W);
}

TEST(RoutePlan, LoopsGoOverStairsAgain) {
  const RoutePlan plan = plan_route(house(), in("hall"), through({"gallery", "hall"}, 3), {});
  EXPECT_EQ(climbs(plan, 1.0), 3);
  EXPECT_EQ(climbs(plan, -1.0), 3);
}

TEST(RoutePlan, AShuttleMayLieOnAnotherStorey) {
  Route route;
  route.shuttle = "north_bedroom";
  route.times = 3;
  const RoutePlan plan = plan_route(house(), in("living"), route, {});
  EXPECT_EQ(climbs(plan, 1.0), 1);
  EXPECT_EQ(climbs(plan, -1.0), 0);
  EXPECT_EQ(plan.waypoints.back().p_W.z(), 2.9);
}

// It went on through the door, and said that the room cannot be reached.
TEST(RoutePlan, AShuttleTurnsBeforeADoorInTheEndWall) {
  const bim::Building rooms = bim::read_plan_text(
      "plan: 1\nstoreys: [{id: g}]\nwalls:\n"
      "  - {id: south, storey: g, a: [0, 0], b: [12, 0]}\n  - {id: east, storey: g, a: [12, 0], b: [12, 5]}\n"
      "  - {id: north, storey: g, a: [12, 5], b: [0, 5]}\n  - {id: west, storey: g, a: [0, 5], b: [0, 0]}\n"
      "  - {id: middle, storey: g, a: [6, 0], b: [6, 5]}\n"
      "openings: [{id: door, wall: middle, kind: door, s_m: 2.5, width_m: 1.0, height_m: 2.1}]\n"
      "rooms:\n  - {id: a, storey: g, polygon: [[0.1, 0.1], [5.9, 0.1], [5.9, 4.9], [0.1, 4.9]]}\n"
      "  - {id: b, storey: g, polygon: [[6.1, 0.1], [11.9, 0.1], [11.9, 4.9], [6.1, 4.9]]}\n",
      "rooms.plan.yaml");
  Route route;
  route.shuttle = "a";
  const RoutePlan plan = plan_route(rooms, in("a"), route, {});
  double farthest = 0.0;
  for (const sim::Waypoint& waypoint : plan.waypoints) farthest = std::max(farthest, waypoint.p_W.x());
  EXPECT_LT(farthest, 5.9);
  EXPECT_GT(farthest, 5.0);
}

/// One room with walls all round.
bim::Building cell_of(const Polygon2& outline) {
  bim::Building cell;
  cell.storeys.push_back({"ground", "ground", 0.0, 3.0, 0});
  bim::Room room;
  room.id = room.name = "cell";
  room.storey = 0;
  room.polygon = outline;
  cell.rooms.push_back(room);
  for (std::size_t i = 0; i < outline.size(); ++i) {
    bim::Wall wall;
    wall.id = std::to_string(i);
    wall.storey = 0;
    wall.a = outline[i];
    wall.b = outline[(i + 1) % outline.size()];
    wall.offset_m = -0.2;
    cell.walls.push_back(wall);
  }
  return cell;
}

// The last place where the robot fits could be one from which no path leads back: "cannot be reached".
TEST(RoutePlan, AShuttleTurnsWhereAPathLeadsBack) {
  Route route;
  route.shuttle = "cell";
  route.times = 2;
  for (const int corners : {5, 7, 12, 40}) {
    Polygon2 outline;
    for (int k = 0; k < corners; ++k)
      outline.emplace_back(8.0 * std::cos(2.0 * std::numbers::pi * k / corners),
                           8.0 * std::sin(2.0 * std::numbers::pi * k / corners));
    const bim::Building cell = cell_of(outline);
    ASSERT_NO_THROW({ EXPECT_GT(plan_route(cell, in("cell"), route, {}).length_m, 30.0) << corners; }) << corners;
  }
}

TEST(RoutePlan, AShuttleNeedsRoom) {
  const bim::Building cell = cell_of({{0.0, 0.0}, {1.1, 0.0}, {1.1, 1.1}, {0.0, 1.1}});
  Route route;
  route.shuttle = "cell";
  EXPECT_NE(error_of(cell, in("cell"), route).find("room 'cell' is too small to walk to and fro in"), std::string::npos)
      << error_of(cell, in("cell"), route);
}

TEST(RoutePlan, WithoutRoomsItWalksTheLargestPieceOfFloorOrWhereItIsTold) {
  bim::Building decks;
  decks.storeys.push_back({"ground", "ground", 0.0, 3.0, 0});
  const auto deck = [&](double x0, double x1, double y1) {
    bim::Slab slab;
    slab.id = "deck" + std::to_string(decks.slabs.size());
    slab.storey = 0;
    slab.polygon.outer = {{x0, 0.0}, {x1, 0.0}, {x1, y1}, {x0, y1}};
    decks.slabs.push_back(slab);
  };
  deck(0.0, 4.0, 4.0);    // has the place furthest from any edge
  deck(10.0, 30.0, 2.4);  // has more floor
  const Route all = through({"all"});
  const RoutePlan free = plan_route(decks, {}, all, {});
  EXPECT_GT(free.start_W.x(), 10.0);
  EXPECT_GT(free.length_m, 20.0);
  // From the small one every further place of the large one is out of reach.
  const RoutePlan told = plan_route(decks, at("ground", 2.0, 2.0), all, {});
  EXPECT_GT(told.length_m, 2.0);
  for (const sim::Waypoint& waypoint : told.waypoints) EXPECT_LT(waypoint.p_W.x(), 4.0);
}

TEST(RoutePlan, ARoomWithoutAWayUpIsRefused) {
  bim::Building flat = house();
  flat.stairs.clear();
  EXPECT_EQ(error_of(flat, in("living"), through({"study"})).rfind("room 'study' cannot be reached from [", 0), 0U);
  EXPECT_NE(error_of(flat, in("living"), through({"study"})).find("storey 'upper': the building has no stairs"),
            std::string::npos);
  bim::Building mesh = house();
  mesh.stairs.front().flights.clear();
  const std::string text = error_of(mesh, in("living"), through({"study"}));
  EXPECT_NE(text.find("storey 'upper': stair 'stair' is a body without recognizable steps"), std::string::npos) << text;
  Route all;
  all.storeys = RouteStoreys::all;
  EXPECT_EQ(climbs(plan_route(mesh, in("living"), all, {}), 1.0), 0);
}

TEST(RoutePlan, AClosedDoorBeyondTheStairIsNamed) {
  bim::Building shut = house();
  for (bim::Opening& opening : shut.openings)
    if (opening.id == "door_study") opening.leaf = bim::Leaf::closed;
  const std::string text = error_of(shut, in("living"), through({"study"}));
  EXPECT_NE(text.find("door 'door_study' on the way is closed"), std::string::npos) << text;
}

TEST(RoutePlan, AStartBesideABentWallsBodyIsInNoWall) {
  bim::Building bent = house();
  bim::Wall& wall = bent.walls.emplace_back(bent.walls.front());
  wall.id = "bent";
  wall.a = {6.0, 1.5};
  wall.b = {9.0, 1.5};
  wall.offset_m = -1.1;
  wall.thickness_m = 2.2;
  wall.body = bim::extrude(
      unite(std::vector<Polygon2>{{{6.0, 0.4}, {9.0, 0.4}, {9.0, 2.6}, {8.9, 2.6}, {8.9, 0.5}, {6.0, 0.5}}}), 0.0, 2.7);
  EXPECT_EQ(error_of(bent, at("ground", 7.0, 1.6), through({"hall"})).find("inside a wall"), std::string::npos);
  EXPECT_NE(error_of(bent, at("ground", 7.0, 0.45), through({"hall"})).find("is inside a wall ('bent')"),
            std::string::npos);
}

TEST(RoutePlan, StartsThatCannotBeAreRefused) {
  const auto refused = [&](const Start& start) { return error_of(house(), start, through({"hall"})); };
  EXPECT_NE(refused(at("ground", 5.2, 1.0)).find("is inside a wall ('spine')"), std::string::npos);
  EXPECT_NE(refused(at("ground", 7.5, 4.4)).find("is on stair 'stair'; it must be on the floor"), std::string::npos);
  EXPECT_NE(refused(at("upper", 9.2, 5.0)).find("is on stair 'stair'"), std::string::npos);
  EXPECT_NE(refused(at("ground", 2.4, 2.4)).find("too near to a wall or another thing"), std::string::npos);
  EXPECT_NE(refused(at("attic", 2.0, 2.0)).find("unknown storey 'attic'"), std::string::npos);
  EXPECT_NE(error_of(house(), in("living"), through({"studdy"})).find("did you mean 'study'"), std::string::npos);
  EXPECT_NE(error_of(house(), in("cellar"), through({"study"})).find("unknown room 'cellar'"), std::string::npos);
}

/// A hall around a core that no door leads to; the core has more floor than the hall around it.
bim::Building around_a_core() {
  bim::Building building = bim::read_plan_text(
      "plan: 1\nstoreys: [{id: g}]\nwalls:\n"
      "  - {id: s, storey: g, a: [0, 0], b: [14, 0]}\n"
      "  - {id: e, storey: g, a: [14, 0], b: [14, 10]}\n"
      "  - {id: n, storey: g, a: [14, 10], b: [0, 10]}\n"
      "  - {id: w, storey: g, a: [0, 10], b: [0, 0]}\n"
      "rooms: [{id: hall, storey: g, polygon: [[0, 0], [14, 0], [14, 10], [0, 10]]}]\n",
      "core.plan.yaml");
  // Only IFC has such rooms; plans are refused.
  const Polygon2 core = {{1.5, 1.5}, {12.5, 1.5}, {12.5, 8.5}, {1.5, 8.5}};
  for (std::size_t i = 0; i < core.size(); ++i) {
    bim::Wall wall = building.walls[0];
    wall.id = "core" + std::to_string(i);
    wall.a = core[i];
    wall.b = core[(i + 1) % core.size()];
    building.walls.push_back(wall);
  }
  return building;
}

TEST(RoutePlan, OfARoomInPiecesTheOneOfTheStartIsTheGoal) {
  const bim::Building building = around_a_core();
  const auto in_core = [](const Eigen::Vector2d& p) { return contains({{1, 1}, {13, 1}, {13, 9}, {1, 9}}, p); };
  for (const bool inside : {true, false}) {
    const Start start = inside ? at("g", 3.0, 3.0) : at("g", 7.0, 0.8);
    const RoutePlan plan = plan_route(building, start, through({"hall"}), {});
    EXPECT_EQ(in_core(plan.waypoints.back().p_W.head<2>()), inside);
  }
  EXPECT_TRUE(in_core(plan_route(building, in("hall"), through({"hall"}), {}).start_W));
}

TEST(RoutePlan, ARoomBehindAHoleInTheFloorSaysSo) {
  bim::Building building = house();
  const int kitchen = find_room(building, "kitchen", {});
  building.rooms[static_cast<std::size_t>(kitchen)].name = "Galley";
  Polygon2 hole = building.rooms[static_cast<std::size_t>(find_room(building, "hall", {}))].polygon;
  for (bim::Slab& slab : building.slabs)
    if (slab.storey == 0) slab.polygon.holes.push_back({hole.rbegin(), hole.rend()});
  const std::string error = error_of(building, in("living"), through({"kitchen"}));
  EXPECT_EQ(error.rfind("room 'kitchen' (Galley) cannot be reached from [", 0), 0U) << error;
  EXPECT_NE(error.find("there is no floor near ["), std::string::npos) << error;
}

}  // namespace
}  // namespace plumbline::scenarios
