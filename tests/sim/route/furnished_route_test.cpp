// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "bim/formats/plan_yaml/plan_furniture.h"
#include "bim/formats/plan_yaml/plan_write.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/furniture/alter.h"
#include "bim/generators/generators.h"
#include "sim/route/route.h"

namespace plumbline::sim {
namespace {

bim::Building furnished(const std::string& family, double density) {
  bim::GeneratedPlan generated = bim::generate(family, Tree::map().set("seed", 1));
  bim::FurnishOptions options;
  options.density = density;
  bim::furnish_plan(generated.plan, options);
  return bim::read_plan_text(bim::write_plan(generated.plan), family + ".plan.yaml");
}

/// The robot turns in every room and gets from each to each.
void expect_all_rooms_reached(const bim::Building& building) {
  for (std::size_t storey = 0; storey < building.storeys.size(); ++storey) {
    const ClearanceMap map(building, static_cast<int>(storey));
    std::vector<Eigen::Vector2d> targets;
    for (const bim::Room& room : building.rooms) {
      if (room.storey != static_cast<int>(storey)) continue;
      const std::vector<Eigen::Vector2d> target = map.room_targets(room);
      ASSERT_FALSE(target.empty()) << room.id;
      targets.push_back(target.front());
    }
    ASSERT_FALSE(targets.empty());
    EXPECT_EQ(map.reachable(targets.front(), targets).size(), targets.size());
  }
}

class FurnishedRoute : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Families, FurnishedRoute, testing::Values("corridor", "rot180", "hall", "long", "storeys"));

TEST_P(FurnishedRoute, EveryRoomIsReachedAtEveryDensity) {
  for (const double density : {0.1, 0.25, 0.4}) expect_all_rooms_reached(furnished(GetParam(), density));
}

TEST_P(FurnishedRoute, EveryRoomIsReachedWhenFurnitureIsElsewhere) {
  for (const bim::FurnitureWorld world : {bim::FurnitureWorld::moved, bim::FurnitureWorld::swapped,
                                          bim::FurnitureWorld::more, bim::FurnitureWorld::unknown}) {
    bim::Building building = furnished(GetParam(), 0.2);
    bim::alter_furniture(building, world, 1);
    expect_all_rooms_reached(building);
  }
}

}  // namespace
}  // namespace plumbline::sim
