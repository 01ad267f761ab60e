// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/localizability_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <numbers>

#include "bim/formats/plan_yaml/plan_write.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/generators/generators.h"
#include "bim/symmetry/isometry.h"
#include "scenarios/localizability/aliased_poses.h"
#include "scenarios/localizability/building_map.h"

namespace plumbline::scenarios {
namespace {

bim::Site site_of(const std::string& family, const std::string& options) {
  const Tree tree = options.empty() ? Tree::map() : read_yaml(options, "options");
  const std::string plan = bim::write_plan(bim::generate(family, tree).plan);
  const bim::Building building = bim::read_plan_text(plan, "generated");
  return {building, building, {}, true};
}

BuildingMap map_at(const bim::Site& site, double step_m) {
  BuildingMapOptions options;
  options.step_m = step_m;
  return map_of(site, options);
}

/// Judges places directly, without any search.
class Direct {
 public:
  explicit Direct(const bim::Site& site)
      : seen_(seen_building(site.as_planned)),
        z_(search_area(site.as_planned, 0).sensor_z_W),
        index_(seen_.scene, {}, 1.0, 1),
        finder_(index_, seen_.scene, seen_.scene) {}

  [[nodiscard]] double llr(const Eigen::Vector2d& p, const bim::Isometry2& g) const {
    const Eigen::Vector2d q = g * p;
    return finder_.llr(finder_.look({{p.x(), p.y(), z_}, 0.0}), {{q.x(), q.y(), z_}, g.angle});
  }

 private:
  SeenBuilding seen_;
  double z_;
  PlaceIndex index_;
  TwinFinder finder_;
};

constexpr double drop = identify_constants.drop_llr;

TEST(IdentifyMap, RoomsOffACorridorHaveEachOtherAsTwinsWhereTheyLookAlike) {
  const bim::Site site = site_of("corridor", "{rooms: 4}");
  const BuildingMap map = map_at(site, 1.0);
  const Direct direct(site);
  constexpr double pitch_m = 4.0;  // rooms are drawn along the middles of their walls
  int in_rooms = 0, with_three = 0;
  for (const MapCell& cell : map.map.cells) {
    const auto room = std::find_if(site.as_planned.rooms.begin(), site.as_planned.rooms.end(),
                                   [&](const bim::Room& r) { return contains(r.polygon, cell.p_W); });
    ASSERT_NE(room, site.as_planned.rooms.end());
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
    EXPECT_EQ(cell.unknown->twins, expected) << room->id << " " << cell.p_W.transpose();
    EXPECT_EQ(cell.compass.twins, expected);
    if (expected > 0) {
      EXPECT_GT(cell.compass.walk_m.value_or(-1.0), 0.0);
    }
  }
  EXPECT_GT(in_rooms, 30);
  EXPECT_GE(with_three, in_rooms / 2);  // elsewhere the end of the corridor shows through the door
}

TEST(IdentifyMap, PointSymmetricFloorHasOneTwinEverywhereThatACompassTellsApart) {
  const BuildingMap map = map_at(site_of("rot180", ""), 1.5);
  EXPECT_GT(map.map.cells.size(), 30U);
  for (const MapCell& cell : map.map.cells) {
    EXPECT_EQ(cell.unknown->twins, 1);
    EXPECT_FALSE(cell.unknown->walk_m.has_value());
    EXPECT_EQ(cell.compass.twins, 0);
    EXPECT_EQ(cell.compass.walk_m, 0.0);
  }
}

TEST(IdentifyMap, MirrorImagesAreNoTwins) {
  const bim::Site site = site_of("mirrored", "");
  const BuildingMap map = map_at(site, 1.5);
  int cells = 0;
  for (const MapCell& cell : map.map.cells) {
    // The kitchens are rectangles with the door in the middle, so that one is also a shift of the other.
    const auto in = [&](const bim::Room& room) {
      return room.id.starts_with("kitchen") && contains(room.polygon, cell.p_W);
    };
    if (std::any_of(site.as_planned.rooms.begin(), site.as_planned.rooms.end(), in)) continue;
    EXPECT_EQ(cell.unknown->twins, 0) << cell.p_W.transpose();
    ++cells;
  }
  EXPECT_GT(cells, 30);
}

TEST(IdentifyMap, AsymmetricFloorsHaveNoTwins) {
  const char* source = std::getenv("PLUMBLINE_SOURCE");
  ASSERT_NE(source, nullptr);
  const bim::Site site = bim::load_site(std::string(source) + "/scenarios/library/house.plan.yaml");
  const BuildingMap map = map_at(site, 1.5);
  EXPECT_GT(map.map.cells.size(), 30U);
  for (const MapCell& cell : map.map.cells) EXPECT_EQ(cell.unknown->twins, 0) << cell.p_W.transpose();
}

TEST(IdentifyMap, OnePillarTellsWhereItOrItsPlaceIsSeenAndOnlyThere) {
  const bim::Site site = site_of("rot180", "{feature: column, epsilon_m: 0.4}");
  const BuildingMap map = map_at(site, 1.0);
  const Direct direct(site);
  const Eigen::AlignedBox2d box = [&] {
    const IdentifyStorey area = search_area(site.as_planned, 0);
    return Eigen::AlignedBox2d(area.min, area.max);
  }();
  const bim::Isometry2 half_turn = bim::Isometry2::turn(std::numbers::pi, box.center());
  int blind = 0, told = 0;
  for (const MapCell& cell : map.map.cells) {
    const double llr = direct.llr(cell.p_W, half_turn);
    // The search may find a better twin than the exact half turn, by what a pillar of which little shows pulls.
    if (llr <= identify_constants.weak_llr) {
      EXPECT_EQ(cell.unknown->twins, 1) << cell.p_W.transpose() << " " << llr;
    }
    if (llr > 2.0 * drop) {
      EXPECT_EQ(cell.unknown->twins, 0) << cell.p_W.transpose() << " " << llr;
    }
    if (llr < 1e-6) ++blind;
    if (llr > 2.0 * drop) ++told;
    ASSERT_TRUE(cell.unknown->walk_m.has_value());
    EXPECT_EQ(*cell.unknown->walk_m == 0.0, cell.unknown->twins == 0);
  }
  EXPECT_GT(blind, 30);
  EXPECT_GT(told, 8);
}

TEST(IdentifyMap, StoreysThatAreAlikeAreTwinsOnlyAcross) {
  const bim::Site site = site_of("storeys", "{storeys: 3}");
  BuildingMapOptions options;
  options.step_m = 2.0;
  options.storey = "ground";
  options.compass_only = true;
  for (const MapCell& cell : map_of(site, options).map.cells) EXPECT_EQ(cell.compass.twins, 0);
  options.across = true;
  const BuildingMap across = map_of(site, options);
  EXPECT_GT(across.map.cells.size(), 5U);
  for (const MapCell& cell : across.map.cells) EXPECT_EQ(cell.compass.twins, 2);
}

TEST(IdentifyMap, ThreadsDoNotChangeAByte) {
  const bim::Site site = site_of("corridor", "{rooms: 2, feature: column, epsilon_m: 0.2}");
  BuildingMapOptions options;
  options.step_m = 1.0;
  const BuildingMap one = map_of(site, options);
  options.threads = 3;
  const BuildingMap three = map_of(site, options);
  EXPECT_EQ(write_json(identify_json(site, one)), write_json(identify_json(site, three)));
  EXPECT_EQ(identify_page(site, "x", one), identify_page(site, "x", three));
}

}  // namespace
}  // namespace plumbline::scenarios
