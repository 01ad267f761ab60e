// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/moving.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bim/errors.h"
#include "bim/load/load.h"
#include "tests/data.h"
#include "tests/input_error.h"

namespace plumbline::scenarios {
namespace {

const bim::Building& house() {
  static const bim::Building building = [] {
    return bim::load_planned_and_built(project_file("scenarios/library/house.plan.yaml")).as_built;
  }();
  return building;
}

ScenarioText with(const std::string& keys) {
  return read_scenario("scenario: 1\nbuilding: house.plan.yaml\n" + keys, "s.yaml");
}

std::string error_of(const std::string& keys) {
  return input_error([&] {
    const ScenarioText text = with(keys);
    (void)place_people(house(), text.scenario, text.tree, 0);
    (void)place_doors(house(), text.scenario, text.tree);
  });
}

TEST(Moving, PeopleWalkThroughDoorsFromRoomToRoom) {
  const ScenarioText text = with("people:\n  - {rooms: [kitchen, hall], speed_mps: 1.1}\n  - {points: [[1, 2]]}\n");
  const auto people = place_people(house(), text.scenario, text.tree, 0);
  ASSERT_EQ(people.size(), 2U);
  EXPECT_EQ(people[0].speed_mps, 1.1);
  ASSERT_GE(people[0].points_W.size(), 2U);
  const auto inside = [&](const std::string& id, const Eigen::Vector3d& p) {
    for (const bim::Room& room : house().rooms)
      if (room.id == id) return contains(room.polygon, p.head<2>());
    return false;
  };
  EXPECT_TRUE(inside("kitchen", people[0].points_W.front()));
  EXPECT_TRUE(inside("hall", people[0].points_W.back()));
  EXPECT_EQ(people[1].points_W, std::vector<Eigen::Vector3d>{Eigen::Vector3d(1, 2, 0)});
}

TEST(Moving, LeavesFillTheirDoorsAndOpenToTheirSide) {
  for (const char* hinge : {"a", "b"})
    for (const char* swing : {"left", "right"}) {
      const ScenarioText text = with(std::string("moving_doors:\n  - {door: door_hall, hinge: ") + hinge +
                                     ", swing: " + swing + ", angle_deg: 90}\n");
      const auto doors = place_doors(house(), text.scenario, text.tree);
      ASSERT_EQ(doors.size(), 1U);
      for (const bim::Opening& opening : house().openings) {
        if (opening.id != "door_hall") continue;
        const bim::Wall& wall = house().walls[static_cast<std::size_t>(opening.wall)];
        const auto tip = [&](double yaw) -> Eigen::Vector2d {
          return doors[0].hinge_W.head<2>() + doors[0].width_m * Eigen::Vector2d(std::cos(yaw), std::sin(yaw));
        };
        const Eigen::Vector2d middle = 0.5 * (doors[0].hinge_W.head<2>() + tip(doors[0].yaw_closed));
        const Eigen::Vector2d expected =
            wall.a + opening.s_m * wall.direction() + (wall.offset_m + 0.5 * wall.thickness_m) * wall.left();
        EXPECT_NEAR((middle - expected).norm(), 0.0, 1e-9);
        const double side = wall.left().dot(tip(doors[0].yaw_closed + doors[0].swing) - doors[0].hinge_W.head<2>());
        EXPECT_NEAR(side, (std::string(swing) == "left" ? 1.0 : -1.0) * doors[0].width_m, 1e-9);
      }
    }
}

TEST(Moving, ComplaintsNameTheEntry) {
  EXPECT_EQ(error_of(""), "no error");
  EXPECT_NE(error_of("people:\n  - {rooms: [kitchn]}\n").find("s.yaml:4:"), std::string::npos);
  EXPECT_NE(error_of("people:\n  - {rooms: [kitchn]}\n").find("did you mean 'kitchen'"), std::string::npos);
  EXPECT_NE(error_of("people:\n  - {speed_mps: 1}\n").find("either rooms or points"), std::string::npos);
  EXPECT_NE(error_of("people:\n  - {rooms: [hall], points: [[1, 1]]}\n").find("either"), std::string::npos);
  EXPECT_NE(error_of("moving_doors:\n  - {door: door_hal}\n").find("did you mean 'door_hall'"), std::string::npos);
  EXPECT_NE(error_of("moving_doors:\n  - {door: front_door}\n").find("closed in the building"), std::string::npos);
  EXPECT_NE(error_of("moving_doors:\n  - {door: door_hall, times_s: [3, 2]}\n").find("ascend"), std::string::npos);
}

}  // namespace
}  // namespace plumbline::scenarios
