// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/alike.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "bim/formats/plan_yaml/plan_write.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/generators/generators.h"
#include "scenarios/localizability/building_map.h"
#include "scenarios/report/alike_list.h"
#include "scenarios/report/localizability_page.h"

namespace plumbline::scenarios {
namespace {

RunBuilding generated(const std::string& family, const std::string& options) {
  const std::string plan = bim::write_plan(bim::generate(family, read_yaml(options, "options")).plan);
  const bim::Building building = bim::read_plan_text(plan, "generated");
  return RunBuilding(bim::PlannedAndBuilt{building, building, {}, true});
}

BuildingMap map_at(const RunBuilding& building, double step_m) {
  BuildingMapOptions options;
  options.step_m = step_m;
  return map_of(building, options);
}

TEST(Alike, NothingDistinguishesTwoFlatsOfWhichOneIsTheOtherTurned) {
  const RunBuilding building = generated("rot180", "{}");
  const BuildingMap map = map_at(building, 1.5);
  ASSERT_EQ(map.alike.motions.size(), 1U);
  EXPECT_NEAR(std::abs(map.alike.motions[0].transform.yaw()), std::numbers::pi, 1e-3);
  EXPECT_EQ(map.alike.motions[0].places, static_cast<int>(map.map.cells.size()));
  EXPECT_FALSE(map.alike.motions[0].distinguished);
  EXPECT_TRUE(shown_alike(map, true).motions.empty());
  EXPECT_NE(list_alike(building, map.alike).find("nothing on these floors"), std::string::npos);
}

TEST(Alike, AMovedDoorDistinguishesTheHalvesOfACorridor) {
  const RunBuilding building = generated("corridor", "{rooms: 4, sides: both, feature: door_shift, epsilon_m: 0.5}");
  const BuildingMap map = map_at(building, 1.0);
  const auto turned = std::find_if(map.alike.motions.begin(), map.alike.motions.end(), [](const Alike& one) {
    return std::abs(std::abs(one.transform.yaw()) - std::numbers::pi) < 1e-3 && one.places > 40;
  });
  ASSERT_NE(turned, map.alike.motions.end());
  ASSERT_TRUE(turned->distinguished);
  // The wall with the shifted door, or the end of the corridor where the turned one has another length.
  EXPECT_EQ(turned->distinguished->element.rfind("corridor-room_", 0), 0U) << turned->distinguished->element;
  EXPECT_GT(turned->distinguished->share, 0.3);
  const std::string page = localizability_page(building, "c.plan.yaml", {map, std::nullopt});
  EXPECT_NE(page.find("class=\"deciding\""), std::string::npos);
  EXPECT_NE(page.find("What looks alike, and what distinguishes it"), std::string::npos);
}

TEST(Alike, AMotionAndItsInverseAreOne) {
  const BuildingMap map = map_at(generated("corridor", "{rooms: 4}"), 1.0);
  ASSERT_GE(map.alike.motions.size(), 2U);
  for (std::size_t i = 0; i < map.alike.motions.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const Pose both = map.alike.motions[i].transform * map.alike.motions[k].transform;
      EXPECT_GT(both.t.head<2>().norm() + std::abs(both.yaw()), 0.1) << i << " undoes " << k;
    }
}

TEST(Alike, MotionsAreSaidInWords) {
  EXPECT_EQ(motion_text(Pose::from_xyz_yaw({4.0, 0.0, 0.0}, 0.0)), "moved by 4 m along x");
  EXPECT_EQ(motion_text(Pose::from_xyz_yaw({0.0, -4.0, 3.0}, 0.0)), "moved by 4 m along -y, 3 m higher");
  EXPECT_EQ(motion_text(Pose::from_xyz_yaw({16.0, 2.4, 0.0}, std::numbers::pi)), "turned by 180° about (8, 1.2)");
  EXPECT_EQ(motion_text(Pose::from_xyz_yaw({0.0, 0.0, -3.0}, 0.0)), "3 m lower");
}

}  // namespace
}  // namespace plumbline::scenarios
