// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/search_area.h"

#include <gtest/gtest.h>

#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/model/extrude.h"

namespace plumbline::scenarios {
namespace {

bim::Building room_with_a_wall() {
  bim::Building building = bim::read_plan_text(
      "plan: 1\nstoreys: [{id: g}]\nwalls: [{id: w, storey: g, a: [0, 0], b: [8, 0]}]\n"
      "rooms: [{id: r, storey: g, polygon: [[0, 0], [8, 0], [8, 6], [0, 6]]}]\n",
      "wall.plan.yaml");
  building.walls.front().a = {2.0, 1.0};
  building.walls.front().b = {6.0, 1.0};
  return building;
}

TEST(SearchArea, HoldsRoomsThatReachBeyondTheWalls) {
  const SearchArea area = search_area(room_with_a_wall(), 0);
  EXPECT_EQ(area.min, Eigen::Vector2d(0.0, 0.1));  // the room begins at the face of its wall
  EXPECT_EQ(area.max, Eigen::Vector2d(8.0, 6.0));
}

TEST(SearchArea, HoldsWhereACurvedWallGoesPastItsChord) {
  bim::Building building = room_with_a_wall();
  building.rooms.clear();
  const PolygonWithHoles2 bow{{{2.0, 1.0}, {4.0, -1.0}, {6.0, 1.0}, {4.0, -0.8}}, {}};
  building.walls.front().body = bim::extrude({bow}, 0.0, 3.0);
  EXPECT_NEAR(search_area(building, 0).min.y(), -1.0, 1e-9);
}

/// What reaches out beyond the walls leaves the places between them where they are.
TEST(SearchArea, GridsGoThroughTheCornerOfTheWalls) {
  SearchArea area;
  area.min = {-1.3, 0.0};
  area.max = {2.0, 2.0};
  EXPECT_EQ(area.lines(0, 1.0), (std::vector<double>{-0.5, 0.5, 1.5}));
  area.corner = {0.25, 0.0};
  EXPECT_EQ(area.lines(0, 1.0), (std::vector<double>{-1.25, -0.25, 0.75, 1.75}));
  EXPECT_EQ(area.lines(1, 1.0), (std::vector<double>{0.5, 1.5}));
}

TEST(SearchArea, TheSensorIsOverTheFloorAtItsPlace) {
  bim::Building building = room_with_a_wall();
  bim::Slab slab;
  slab.id = "raised";
  slab.storey = 0;
  slab.polygon.outer = {{1.0, 1.0}, {4.0, 1.0}, {4.0, 5.0}, {1.0, 5.0}};
  slab.z0_m = 0.0;
  slab.z1_m = 0.235;
  building.slabs.push_back(slab);
  const SearchArea area = search_area(building, 0);
  const double flat = area.sensor_z_W({6.0, 3.0});
  EXPECT_NEAR(area.sensor_z_W({2.0, 3.0}) - flat, 0.235, 1e-9);
  const std::vector<bim::WalkedFloors> floors = storey_floors(building);
  EXPECT_NEAR(sensor_z_W(floors, {2.0, 3.0, 0.24}, 0.02) - flat, 0.235, 1e-9);
  EXPECT_NEAR(sensor_z_W(floors, {2.0, 3.0, 0.1}, 0.02) - flat, 0.1, 1e-9);  // on a stair
}

TEST(SearchArea, IsEmptyWithoutWallsAndRooms) {
  bim::Building building = room_with_a_wall();
  building.rooms.clear();
  building.walls.clear();
  const SearchArea area = search_area(building, 0);
  EXPECT_TRUE(area.empty());
  EXPECT_TRUE(area.lines(0, 0.5).empty());
}

}  // namespace
}  // namespace plumbline::scenarios
