// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/localizability_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numbers>

#include "bim/errors.h"
#include "bim/formats/plan_yaml/plan_write.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/generators/generators.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/model/extrude.h"
#include "bim/model/permanence.h"
#include "bim/symmetry/isometry.h"
#include "scenarios/localizability/aliased_poses.h"
#include "scenarios/report/localizability_page.h"
#include "tests/data.h"

namespace plumbline::scenarios {
namespace {

std::shared_ptr<const RunBuilding> building_of(const std::string& family, const std::string& options) {
  const Tree tree = options.empty() ? Tree::map() : read_yaml(options, "options");
  const std::string plan = bim::write_plan(bim::generate(family, tree).plan);
  const bim::Building building = bim::read_plan_text(plan, "generated");
  return std::make_shared<const RunBuilding>(bim::PlannedAndBuilt{building, building, {}, true});
}

BuildingMap map_at(const RunBuilding& building, double step_m) {
  BuildingMapOptions options;
  options.step_m = step_m;
  return map_of(building, options);
}

/// Judges places directly, without any search.
class Direct {
 public:
  explicit Direct(const RunBuilding& building)
      : visible_(visible_building(building)),
        z_(search_area(building.as_planned(), 0).sensor_z_W({0.0, 0.0})),
        index_(visible_.planned.scene, {}, 1.0, 1),
        finder_(index_, visible_.planned.scene, visible_.planned.scene) {}

  [[nodiscard]] double llr(const Eigen::Vector2d& p, const bim::Isometry2& g) const {
    const Eigen::Vector2d q = g * p;
    return finder_.llr(finder_.scan_at({{p.x(), p.y(), z_}, 0.0}), {{q.x(), q.y(), z_}, g.angle});
  }

 private:
  VisibleBuilding visible_;
  double z_;
  PlaceIndex index_;
  AliasFinder finder_;
};

constexpr double drop = localizability_constants.drop_llr;

TEST(LocalizabilityMap, RoomsOffACorridorAreAliasedWhereTheyMeasureAlike) {
  const auto building = building_of("corridor", "{rooms: 4}");
  const BuildingMap map = map_at(*building, 1.0);
  const Direct direct(*building);
  constexpr double pitch_m = 4.0;  // rooms are drawn along the middles of their walls
  int in_rooms = 0, with_three = 0;
  for (const MapCell& cell : map.map.cells) {
    const auto room = std::find_if(building->as_planned().rooms.begin(), building->as_planned().rooms.end(),
                                   [&](const bim::Room& r) { return contains(r.polygon, cell.p_W); });
    ASSERT_NE(room, building->as_planned().rooms.end());
    int expected = 0;
    if (room->id != "corridor") {
      const int own = room->id.back() - '1';
      for (int other = 0; other < 4; ++other) {
        const bim::Isometry2 g{0.0, {pitch_m * (other - own), 0.0}, false};
        if (other != own && direct.llr(cell.p_W, g) <= drop) ++expected;
      }
      ++in_rooms;
      if (expected == 3) ++with_three;
    }
    EXPECT_EQ(cell.unknown->aliases, expected) << room->id << " " << cell.p_W.transpose();
    EXPECT_EQ(cell.compass.aliases, expected);
    if (expected > 0) {
      EXPECT_GT(cell.compass.walk_m.value_or(-1.0), 0.0);
    }
  }
  EXPECT_GT(in_rooms, 30);
  EXPECT_GE(with_three, in_rooms / 2);  // elsewhere the end of the corridor shows through the door
}

TEST(LocalizabilityMap, PointSymmetricFloorHasOneAliasEverywhereThatACompassRulesOut) {
  const BuildingMap map = map_at(*building_of("rot180", ""), 1.5);
  EXPECT_GT(map.map.cells.size(), 30U);
  for (const MapCell& cell : map.map.cells) {
    EXPECT_EQ(cell.unknown->aliases, 1);
    EXPECT_FALSE(cell.unknown->walk_m.has_value());
    EXPECT_EQ(cell.compass.aliases, 0);
    EXPECT_EQ(cell.compass.walk_m, 0.0);
  }
}

/// A piece of furniture or, where it is not planned, clutter.
bim::Obstacle box_at(const std::string& id, const Eigen::Vector2d& low, const Eigen::Vector2d& size, double height_m,
                     bool planned) {
  const Eigen::Vector2d high = low + size;
  bim::Obstacle box;
  box.id = id;
  box.kind = "box";
  box.storey = 0;
  box.planned = planned;
  const PolygonWithHoles2 outline{{low, {high.x(), low.y()}, high, {low.x(), high.y()}}, {}};
  box.body = bim::extrude({outline}, 0.0, height_m);
  return box;
}

/// Boxes in every room, of sizes and at places that no turn maps onto one another: some against walls, so that a beam
/// to them ends nearly where the wall is, and low ones before the rest.
std::vector<bim::Obstacle> clutter_of(const bim::Building& building, bool planned) {
  std::vector<bim::Obstacle> boxes;
  for (const bim::Room& room : building.rooms) {
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& p : room.polygon) box.extend(p);
    const auto k = static_cast<double>(boxes.size());
    const Eigen::Vector2d size(0.5 + 0.04 * k, 0.4 + 0.03 * k), flat(0.9 + 0.02 * k, 0.05);
    boxes.push_back(
        box_at(room.id + "_box", box.min() + Eigen::Vector2d(0.5 + 0.02 * k, 0.6), size, 1.1 + 0.05 * k, planned));
    boxes.push_back(box_at(room.id + "_board", box.max() - Eigen::Vector2d(1.5 + 0.03 * k, 0.17), flat, 2.0, planned));
  }
  return boxes;
}

bim::Building with(bim::Building building, const std::vector<bim::Obstacle>& more) {
  building.obstacles.insert(building.obstacles.end(), more.begin(), more.end());
  return building;
}

/// Every place is aliased with its image under the half turn, exactly and for ever. Furniture that hides what differs
/// may leave further places.
void expect_half_turn(const BuildingMap& map, const bim::Building& bare) {
  const SearchArea area = search_area(bare, 0);
  const Eigen::Vector2d center = 0.5 * (area.min + area.max);
  EXPECT_GT(map.map.cells.size(), 20U);
  for (const MapCell& cell : map.map.cells) {
    const auto half_turn = [&](const CellAlias& alias) {
      const Pose& g = map.map.isometries[alias.isometry];
      const Eigen::Vector3d image = g * Eigen::Vector3d(cell.p_W.x(), cell.p_W.y(), 0.0);
      return (image.head<2>() - (2.0 * center - cell.p_W)).norm() < 1e-3 && std::abs(alias.llr) < 1e-3;
    };
    EXPECT_TRUE(std::any_of(cell.aliases.begin(), cell.aliases.end(), half_turn)) << cell.p_W.transpose();
    EXPECT_FALSE(cell.unknown->walk_m.has_value()) << cell.p_W.transpose();
  }
}

TEST(LocalizabilityMap, FurnitureDoesNotMakeASymmetricBuildingKnown) {
  const bim::Building bare = building_of("rot180", "")->as_planned();
  const bim::Building furnished = with(bare, clutter_of(bare, true));
  const RunBuilding planned(bim::PlannedAndBuilt{furnished, furnished, {}, true});
  BuildingMapOptions options;
  options.step_m = 1.5;
  const BuildingMaps maps = maps_of(planned, options);
  expect_half_turn(maps.building, bare);
  ASSERT_TRUE(maps.with_furniture.has_value());
  for (const MapCell& cell : maps.with_furniture->map.cells)
    EXPECT_TRUE(cell.unknown->walk_m.has_value()) << cell.p_W.transpose();
  const std::string text = localizability_text(planned, maps);
  EXPECT_LT(text.find("By the building alone"), text.find("With the furniture as planned"));
  EXPECT_NE(localizability_page(planned, "x", maps).find("With the furniture as planned"), std::string::npos);
  EXPECT_NE(localizability_json(planned, maps).find("with_furniture"), nullptr);
}

TEST(LocalizabilityMap, ClutterThatNoPlanHasMakesNothingKnownEither) {
  const bim::Building bare = building_of("rot180", "")->as_planned();
  const bim::PlannedAndBuilt site{bare, with(bare, clutter_of(bare, false)), {{"add_clutter", "boxes"}}, true};
  BuildingMapOptions options;
  options.step_m = 1.5;
  const BuildingMaps maps = maps_of(RunBuilding(site), options);
  EXPECT_FALSE(maps.with_furniture.has_value());  // nothing planned may have moved
  expect_half_turn(maps.building, bare);
}

TEST(LocalizabilityMap, WhatWasBuiltDecidesBehindFurnitureToo) {
  // A column that no half turn maps onto another makes the building known, wherever a way to it is left.
  const bim::Building bare = building_of("rot180", "{feature: column, epsilon_m: 0.4}")->as_planned();
  const bim::Building furnished = with(bare, clutter_of(bare, true));
  const RunBuilding planned(bim::PlannedAndBuilt{furnished, furnished, {}, true});
  BuildingMapOptions options;
  options.step_m = 1.5;
  const BuildingMap map = map_of(planned, options);
  const MapShare share = share_of(map, false, [](const MapCell&) { return true; });
  EXPECT_GT(share.one_scan + share.walk, share.cells / 2);
  EXPECT_GT(share.one_scan, 5);
  for (const MapCell& cell : map.map.cells)
    if (contains(bare.rooms[1].polygon, cell.p_W)) {  // the column's
      EXPECT_TRUE(cell.unknown->walk_m.has_value()) << cell.p_W.transpose();
    }
}

TEST(LocalizabilityMap, MirrorImagesAreNotAliased) {
  const auto building = building_of("mirrored", "");
  const BuildingMap map = map_at(*building, 1.5);
  int cells = 0;
  for (const MapCell& cell : map.map.cells) {
    // The kitchens are rectangles with the door in the middle, so that one is also a shift of the other.
    const auto in = [&](const bim::Room& room) {
      return room.id.starts_with("kitchen") && contains(room.polygon, cell.p_W);
    };
    if (std::any_of(building->as_planned().rooms.begin(), building->as_planned().rooms.end(), in)) continue;
    EXPECT_EQ(cell.unknown->aliases, 0) << cell.p_W.transpose();
    ++cells;
  }
  EXPECT_GT(cells, 30);
}

TEST(LocalizabilityMap, AsymmetricFloorsHaveNoAliases) {
  const RunBuilding building(bim::load_planned_and_built(project_file("scenarios/library/house.plan.yaml")));
  const BuildingMap map = map_at(building, 1.5);
  EXPECT_GT(map.map.cells.size(), 30U);
  for (const MapCell& cell : map.map.cells) EXPECT_EQ(cell.unknown->aliases, 0) << cell.p_W.transpose();
}

TEST(LocalizabilityMap, OnePillarDecidesWhereItOrItsPlaceIsVisibleAndOnlyThere) {
  const auto building = building_of("rot180", "{feature: column, epsilon_m: 0.4}");
  const BuildingMap map = map_at(*building, 1.0);
  const Direct direct(*building);
  const Eigen::AlignedBox2d box = [&] {
    const SearchArea area = search_area(building->as_planned(), 0);
    return Eigen::AlignedBox2d(area.min, area.max);
  }();
  const bim::Isometry2 half_turn = bim::Isometry2::turn(std::numbers::pi, box.center());
  int blind = 0, ruled_out = 0;
  for (const MapCell& cell : map.map.cells) {
    const double llr = direct.llr(cell.p_W, half_turn);
    // The search may find a better alias than the exact half turn, by what a pillar of which little shows pulls.
    if (llr <= localizability_constants.marginal_llr) {
      EXPECT_EQ(cell.unknown->aliases, 1) << cell.p_W.transpose() << " " << llr;
    }
    if (llr > 2.0 * drop) {
      EXPECT_EQ(cell.unknown->aliases, 0) << cell.p_W.transpose() << " " << llr;
    }
    if (llr < 1e-6) ++blind;
    if (llr > 2.0 * drop) ++ruled_out;
    ASSERT_TRUE(cell.unknown->walk_m.has_value());
    EXPECT_EQ(*cell.unknown->walk_m == 0.0, cell.unknown->aliases == 0);
  }
  EXPECT_GT(blind, 30);
  EXPECT_GT(ruled_out, 8);
}

TEST(LocalizabilityMap, EqualStoreysAreAliasedOnlyAcross) {
  const auto building = building_of("storeys", "{storeys: 3}");
  BuildingMapOptions options;
  options.step_m = 2.0;
  options.storey = "ground";
  options.compass_only = true;
  for (const MapCell& cell : map_of(*building, options).map.cells) EXPECT_EQ(cell.compass.aliases, 0);
  options.across = true;
  const BuildingMap across = map_of(*building, options);
  EXPECT_GT(across.map.cells.size(), 5U);
  for (const MapCell& cell : across.map.cells) EXPECT_EQ(cell.compass.aliases, 2);
}

/// Panels enclose a room where there is no wall.
TEST(LocalizabilityMap, AStoreyWithoutWallsIsMappedByItsRooms) {
  bim::Building building = bim::read_plan_text(
      "plan: 1\nstoreys: [{id: g}]\nwalls: [{id: w, storey: g, a: [0, 0], b: [8, 0]}]\n"
      "rooms: [{id: r, storey: g, polygon: [[0, 0], [8, 0], [8, 6], [0, 6]]}]\n",
      "front.plan.yaml");
  const Polygon2 front{{0, 0}, {8, 0}, {8, 0.1}, {0, 0.1}};
  building.obstacles.push_back(
      {"panel", "curtain_panel", 0, bim::extrude(unite(std::vector<Polygon2>{front}), 0.0, 3.0)});
  building.walls.clear();
  for (bim::Room& room : building.rooms) room.walls.clear();
  BuildingMapOptions options;
  options.step_m = 2.0;
  EXPECT_GT(map_of(RunBuilding(bim::PlannedAndBuilt{building, building, {}, true}), options).map.cells.size(), 6u);
}

/// A wall that goes through two storeys belongs to the lower one.
TEST(LocalizabilityMap, RoomsBeyondTheWallsOfTheirStoreyAreMapped) {
  bim::Building building = bim::read_plan_text(
      "plan: 1\nstoreys: [{id: g}, {id: u, elevation_m: 3, copy_of: g}]\nwalls:\n"
      "  - {id: s, storey: g, a: [0, 0], b: [8, 0]}\n  - {id: e, storey: g, a: [8, 0], b: [8, 6]}\n"
      "  - {id: n, storey: g, a: [8, 6], b: [0, 6]}\n  - {id: w, storey: g, a: [0, 6], b: [0, 0]}\n"
      "  - {id: m, storey: g, a: [3.9, 3], b: [0, 3]}\n"
      "rooms: [{id: r, storey: g, polygon: [[0, 0], [8, 0], [8, 6], [0, 6]]}]\n",
      "tall.plan.yaml");
  for (bim::Wall& wall : building.walls)
    if (wall.storey == 1 && wall.id.find('m') == std::string::npos) wall.storey = 0;
  for (bim::Room& room : building.rooms) room.walls.clear();
  BuildingMapOptions options;
  options.step_m = 1.0;
  options.compass_only = true;
  const RunBuilding tall(bim::PlannedAndBuilt{building, building, {}, true});
  const BuildingMap map = map_of(tall, options);
  ASSERT_EQ(map.floors.size(), 2U);
  EXPECT_EQ(map.floors[0].cells_W.size(), map.floors[1].cells_W.size());
  EXPECT_TRUE(map.bare.empty());
  EXPECT_EQ(localizability_json(tall, {map, std::nullopt}).find("without_places"), nullptr);
}

TEST(LocalizabilityMap, AStoreyWithoutAPlaceIsNamed) {
  const bim::Building building = bim::read_plan_text(
      "plan: 1\nstoreys: [{id: g}, {id: closet, elevation_m: 3}]\nwalls:\n"
      "  - {id: w, storey: g, a: [0, 0], b: [6, 0]}\n  - {id: v, storey: closet, a: [0, 0], b: [0.6, 0]}\n"
      "rooms:\n  - {id: r, storey: g, polygon: [[0, 0], [6, 0], [6, 4], [0, 4]]}\n"
      "  - {id: c, storey: closet, polygon: [[0, 0], [0.6, 0], [0.6, 0.6], [0, 0.6]]}\n",
      "closet.plan.yaml");
  BuildingMapOptions options;
  options.step_m = 2.0;
  options.compass_only = true;
  const RunBuilding tall(bim::PlannedAndBuilt{building, building, {}, true});
  const BuildingMaps maps{map_of(tall, options), std::nullopt};
  EXPECT_EQ(maps.building.bare, std::vector<std::size_t>{1});
  EXPECT_NE(localizability_text(tall, maps).find("closet: no place"), std::string::npos);
  EXPECT_NE(write_json(localizability_json(tall, maps)).find("\"without_places\""), std::string::npos);
}

TEST(LocalizabilityMap, NoPlaceAtAllIsSaid) {
  const bim::Building closet = bim::read_plan_text(
      "plan: 1\nstoreys: [{id: g}]\nwalls: [{id: w, storey: g, a: [0, 0], b: [0.6, 0]}]\n"
      "rooms: [{id: r, storey: g, polygon: [[0, 0], [0.6, 0], [0.6, 0.6], [0, 0.6]]}]\n",
      "closet.plan.yaml");
  const RunBuilding building(bim::PlannedAndBuilt{closet, closet, {}, true});
  EXPECT_THROW(static_cast<void>(map_of(building, {})), InputError);
}

TEST(LocalizabilityMap, ThreadsDoNotChangeAByte) {
  const auto building = building_of("corridor", "{rooms: 2, feature: column, epsilon_m: 0.2}");
  BuildingMapOptions options;
  options.step_m = 1.0;
  const BuildingMaps one = maps_of(*building, options);
  options.threads = 3;
  const BuildingMaps three = maps_of(*building, options);
  EXPECT_EQ(write_json(localizability_json(*building, one)), write_json(localizability_json(*building, three)));
  EXPECT_EQ(localizability_page(*building, "x", one), localizability_page(*building, "x", three));
}

}  // namespace
}  // namespace plumbline::scenarios
