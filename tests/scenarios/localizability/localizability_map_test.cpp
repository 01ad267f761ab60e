// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/localizability_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numbers>

#include "bim/formats/plan_yaml/plan_write.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/generators/generators.h"
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
        z_(search_area(building.as_planned(), 0).sensor_z_W),
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

TEST(LocalizabilityMap, ThreadsDoNotChangeAByte) {
  const auto building = building_of("corridor", "{rooms: 2, feature: column, epsilon_m: 0.2}");
  BuildingMapOptions options;
  options.step_m = 1.0;
  const BuildingMap one = map_of(*building, options);
  options.threads = 3;
  const BuildingMap three = map_of(*building, options);
  EXPECT_EQ(write_json(localizability_json(*building, one)), write_json(localizability_json(*building, three)));
  EXPECT_EQ(localizability_page(*building, "x", one), localizability_page(*building, "x", three));
}

}  // namespace
}  // namespace plumbline::scenarios
