// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/building_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/model/extrude.h"
#include "bim/model/floors.h"
#include "tests/input_error.h"

namespace plumbline::scenarios {
namespace {

/// A room of this depth between four walls.
bim::Building room_of(double depth_m) {
  const std::string y = std::to_string(depth_m);
  return bim::read_plan_text(
      "plan: 1\nstoreys: [{id: g}]\nwalls:\n  - {id: s, storey: g, a: [0, 0], b: [4, 0]}\n"
      "  - {id: e, storey: g, a: [4, 0], b: [4, " +
          y + "]}\n  - {id: n, storey: g, a: [4, " + y + "], b: [0, " + y + "]}\n  - {id: w, storey: g, a: [0, " + y +
          "], b: [0, 0]}\nrooms: [{id: r, storey: g, polygon: [[0, 0], [4, 0], [4, " + y + "], [0, " + y + "]]}]\n",
      "room.plan.yaml");
}

std::string refusal(const bim::Building& building, const BuildingMapOptions& options) {
  const RunBuilding run({building, building, {}, true});
  return input_error([&] { static_cast<void>(map_of(run, options)); });
}

TEST(BuildingMap, StoreysAreListedByNameAndByIdWhereNamesRepeat) {
  bim::Building building = room_of(3.0);
  bim::Storey storey = building.storeys.front();
  building.storeys.front().name = "Ground";
  for (const char* id : {"u1", "u2"}) {
    storey.id = id;
    storey.name = "Upper";
    storey.elevation_m += 3.0;
    building.storeys.push_back(storey);
  }
  BuildingMapOptions options;
  options.storey = "Nope";
  EXPECT_EQ(refusal(building, options),
            "--storey: there is no storey 'Nope'; there are: Ground, Upper (u1), Upper (u2)");
}

TEST(BuildingMap, ARefusalNamesTheFile) {
  BuildingMapOptions options;
  options.file = "narrow.ifc";
  EXPECT_EQ(refusal(room_of(0.6), options).find("narrow.ifc: has no place in its rooms"), 0U);
}

/// A building whose file has no slabs, so that its floor is assumed.
bim::PlannedAndBuilt without_slabs(const bim::Building& hall) {
  bim::PlannedAndBuilt site{hall, hall, {}, true};
  for (bim::Building* building : {&site.as_planned, &site.as_built}) building->slabs.clear();
  site.as_built.slabs = bim::assumed_slabs(site.as_built);
  return site;
}

bim::Building square_hall() {
  return bim::read_plan_text(
      "plan: 1\nstoreys: [{id: g}]\nwalls:\n  - {id: s, storey: g, a: [0, 0], b: [16, 0]}\n"
      "  - {id: e, storey: g, a: [16, 0], b: [16, 16]}\n  - {id: n, storey: g, a: [16, 16], b: [0, 16]}\n"
      "  - {id: w, storey: g, a: [0, 16], b: [0, 0]}\n"
      "rooms: [{id: r, storey: g, polygon: [[0, 0], [16, 0], [16, 16], [0, 16]]}]\n",
      "hall.plan.yaml");
}

TEST(BuildingMap, AnAssumedFloorTellsAsMuchAsASlab) {
  const bim::Building hall = square_hall();
  BuildingMapOptions options;
  options.step_m = 4.0;
  const BuildingMap with_slab = map_of(RunBuilding({hall, hall, {}, true}), options);
  const BuildingMap without = map_of(RunBuilding(without_slabs(hall)), options);
  ASSERT_EQ(without.map.cells.size(), with_slab.map.cells.size());
  for (std::size_t i = 0; i < without.map.cells.size(); ++i) {
    EXPECT_EQ(without.map.cells[i].unknown->aliases, with_slab.map.cells[i].unknown->aliases);
    EXPECT_FALSE(without.map.cells[i].unknown->walk_m.has_value()) << without.map.cells[i].p_W.transpose();
  }
}

TEST(BuildingMap, TheEdgeOfAnAssumedFloorTellsNothing) {
  bim::Building hall = square_hall();
  hall.walls.resize(1);  // its outline is open on three sides
  hall.rooms.front().walls.clear();
  const RunBuilding building(without_slabs(hall));
  const VisibleBuilding visible = visible_building(building);
  const double z = 0.5;
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(8, 8, z), Eigen::Vector3d(8, 15.5, z)})
    EXPECT_NEAR(visible.as_built().scene.cast({p, Eigen::Vector3d(0, 0.8, -0.6), 0.0}, 100.0).range_m, z / 0.6, 1e-6)
        << "the floor ends at 16 m";
}

TEST(BuildingMap, ABuildingWithNothingToSeeIsRefused) {
  bim::Building rooms = square_hall();
  rooms.walls.clear();
  rooms.rooms.front().walls.clear();
  BuildingMapOptions options;
  options.file = "rooms.ifc";
  const RunBuilding building(without_slabs(rooms));
  const std::string refusal = input_error([&] { static_cast<void>(map_of(building, options)); });
  EXPECT_EQ(refusal.find("rooms.ifc: has no wall, column or other element that stays where it is"), 0U) << refusal;
  EXPECT_NE(refusal.find("IfcWall) would help"), std::string::npos) << refusal;
  bim::Building slabs = square_hall();
  slabs.walls.clear();
  slabs.rooms.clear();
  const RunBuilding floor(bim::PlannedAndBuilt{slabs, slabs, {}});
  const std::string other = input_error([&] { static_cast<void>(map_of(floor, options)); });
  EXPECT_NE(other.find("IfcWall) would help"), std::string::npos) << other;
}

/// The straight rectangle of a wall around the whole room covers it; its body does not.
bim::Building round_room() {
  bim::Building building = room_of(3.0);
  Polygon2 outer, inner;
  for (int i = 0; i < 36; ++i) {
    const double angle = i * std::numbers::pi / 18.0;
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    outer.emplace_back(5.0 * along);
    inner.emplace_back(4.8 * along);
  }
  building.walls.resize(1);
  bim::Wall& wall = building.walls.front();
  wall.a = {-5.0, 0.0};
  wall.b = {5.0, 0.0};
  wall.thickness_m = 10.0;
  wall.offset_m = -5.0;
  wall.body = bim::extrude({{outer, {inner}}}, 0.0, 3.0);
  building.rooms.front() = {};
  building.rooms.front().id = "r";
  building.rooms.front().storey = 0;
  building.rooms.front().z1_m = 3.0;
  building.rooms.front().polygon = inner;
  building.slabs.clear();
  bim::Slab slab;
  slab.id = "floor";
  slab.storey = 0;
  slab.polygon.outer = {{-5, -5}, {5, -5}, {5, 5}, {-5, 5}};
  slab.z0_m = -0.2;
  slab.z1_m = 0.0;
  building.slabs.push_back(slab);
  return building;
}

TEST(BuildingMap, ARoundRoomOfOneWallHasPlacesAndIsNotUnique) {
  const bim::Building building = round_room();
  BuildingMapOptions options;
  options.step_m = 2.0;
  const BuildingMap map = map_of(RunBuilding({building, building, {}, true}), options);
  EXPECT_GE(map.map.cells.size(), 9U);
  for (const MapCell& cell : map.map.cells) EXPECT_FALSE(cell.unknown->walk_m.has_value()) << cell.p_W.transpose();
}

/// 36 turns take the room onto itself. Within 10 degrees of the truth a pose is the truth, so a neighbour may be
/// missing.
TEST(BuildingMap, ARoundRoomHasAllTheAliasesOfItsTurns) {
  const bim::Building building = round_room();
  BuildingMapOptions options;
  options.step_m = 3.0;
  const BuildingMap map = map_of(RunBuilding({building, building, {}, true}), options);
  ASSERT_FALSE(map.map.cells.empty());
  for (const MapCell& cell : map.map.cells)
    if (cell.p_W.norm() > 1.0) EXPECT_GE(cell.aliases.size(), 33U) << cell.p_W.transpose();
  // 17 turns with their inverses and the half turn.
  EXPECT_EQ(map.alike.motions.size(), 8U);
  EXPECT_GE(map.alike.others, 9U);
}

/// Rows of pillars along whose faces beams of many places run exactly: rounding says which of them a beam meets.
TEST(BuildingMap, NoPlaceOfASquareHallWithRowsOfPillarsIsUnique) {
  std::string text =
      "plan: 1\nname: hall\nstoreys: [{id: g, elevation_m: 0, height_m: 3}]\nwalls:\n"
      "  - {id: s, storey: g, a: [0, 0], b: [6, 0]}\n  - {id: e, storey: g, a: [6, 0], b: [6, 6]}\n"
      "  - {id: n, storey: g, a: [6, 6], b: [0, 6]}\n  - {id: w, storey: g, a: [0, 6], b: [0, 0]}\n"
      "rooms: [{id: r, storey: g, polygon: [[0, 0], [6, 0], [6, 6], [0, 6]]}]\ncolumns:\n";
  for (const std::string x : {"1.5", "3", "4.5"})
    for (const std::string y : {"1.5", "3", "4.5"})
      text += "  - {id: c" + x + "_" + y + ", storey: g, at: [" + x + ", " + y + "], size: [0.5, 0.5]}\n";
  const bim::Building building = bim::read_plan_text(text, "hall.plan.yaml");
  BuildingMapOptions options;
  options.step_m = 0.5;  // places 0.25 m off, in line with faces of pillars
  const BuildingMap map = map_of(RunBuilding({building, building, {}, true}), options);
  ASSERT_GT(map.map.cells.size(), 40U);
  for (const MapCell& cell : map.map.cells) EXPECT_FALSE(cell.unknown->walk_m.has_value()) << cell.p_W.transpose();
}

TEST(BuildingMap, SaysThatTheScansAreOfTheBuildingAsBuilt) {
  const bim::Building room = room_of(3.0);
  EXPECT_EQ(scanned_text(RunBuilding({room, room, {}, true})), "");
  const RunBuilding altered({room, room, {{"remove_wall", "stub"}, {"reshape_room", "r"}}, true});
  BuildingMapOptions options;
  options.step_m = 1.0;
  const BuildingMaps maps{map_of(altered, options), std::nullopt};
  EXPECT_NE(localizability_text(altered, maps)
                .find("\nThe scans are of the building as built, which differs from its plan in 1 element.\n"),
            std::string::npos)
      << localizability_text(altered, maps);
}

TEST(BuildingMap, ItsJsonHasTheWordsOfTheDocuments) {
  const bim::Building room = room_of(3.0);
  const RunBuilding building({room, room, {}, true});
  BuildingMapOptions options;
  options.step_m = 1.0;
  const std::string text = write_json(localizability_json(building, {map_of(building, options), std::nullopt}));
  for (const char* key : {"\"one_scan\"", "\"aliases\"", "\"aliases_max\""})
    EXPECT_NE(text.find(key), std::string::npos) << key;
  for (const char* former : {"twin", "look"}) EXPECT_EQ(text.find(former), std::string::npos) << text;
}

}  // namespace
}  // namespace plumbline::scenarios
