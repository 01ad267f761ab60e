// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/ground.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "bim/errors.h"
#include "bim/load/load.h"
#include "sim/robot/robot.h"
#include "sim/robot/solid_boxes.h"
#include "sim/route/pure_pursuit.h"
#include "tests/data.h"
#include "tests/sim/route/floor_plan.h"

namespace plumbline::sim {
namespace {

bim::Building library_building(const std::string& name) {
  return bim::load_building(project_file("scenarios/library/" + name));
}

const bim::Building& house() {
  static const bim::Building building = library_building("house.plan.yaml");
  return building;
}

TEST(Ground, OneFloorIsEverywhere) {
  const Ground ground(3.1);
  for (const double x : {-50.0, 0.0, 7.0}) {
    EXPECT_EQ(ground.height(x, 2.0, 4.0), 3.1);
    EXPECT_EQ(ground.plane_height({x, 2.0, 3.6}), 3.1);
  }
}

TEST(Ground, TheSillOfADoorInACurvedWallIsAsDeepAsItsOpening) {
  bim::Building building = empty_storey();
  // A bow from (0, 0) over (3, 1.5) to (6, 0), 0.2 m thick.
  bim::Wall& wall = building.walls[static_cast<std::size_t>(add_wall(building, {0, 0}, {6, 0}))];
  const auto at = [](int i) { return Eigen::Vector2d(0.5 * i, 1.5 * std::sin(std::numbers::pi * i / 12.0)); };
  const Eigen::Vector2d thick(0.0, 0.2);
  bim::Solid body;
  for (int i = 0; i < 12; ++i) {
    const bim::Solid part = prism({at(i), at(i + 1), at(i + 1) + thick, at(i) + thick}, 0.0, 3.0);
    const int first = static_cast<int>(body.vertices.size());
    body.vertices.insert(body.vertices.end(), part.vertices.begin(), part.vertices.end());
    for (const Eigen::Vector3i& t : part.triangles) body.triangles.emplace_back(t.array() + first);
  }
  wall.body = body;
  wall.offset_m = 0.0;
  wall.thickness_m = 1.7;
  bim::Opening& door = add_door(building, 0, 3.0, 1.0);
  door.z0_m = 0.05;
  door.solid = prism(rectangle({2.5, 1.3}, {3.5, 1.9}), 0.05, 2.1);
  const Ground ground = building_ground(building, {0});
  EXPECT_DOUBLE_EQ(ground.height(3.0, 1.6, 1.0), 0.05);
  for (const double y : {0.2, 0.7, 1.2}) EXPECT_DOUBLE_EQ(ground.height(3.0, y, 1.0), 0.0) << y;
}

TEST(Ground, ATiltedBoxIsARamp) {
  CollisionBox ramp;
  ramp.X_WB = {exp_so3({0.0, -0.2, 0.0}), {3.0, 0.0, 0.0}};
  ramp.half = {2.0, 1.0, 0.1};
  const Ground ground({{-1.0, {}}}, {ramp});
  const double middle = ground.height(3.0, 0.0, 2.0);
  EXPECT_NEAR(middle, 0.1 / std::cos(0.2), 1e-12);
  EXPECT_NEAR(ground.height(4.0, 0.5, 2.0) - middle, std::tan(0.2), 1e-12);
  EXPECT_EQ(ground.height(4.0, 1.5, 2.0), -1.0);
}

TEST(BuildingGround, StepsLandingsAndBothFloorsOfTheHouse) {
  const Ground ground = building_ground(house(), {0, 1});
  for (const bim::StairFlight& flight : house().stairs.at(0).flights)
    for (int k = 0; k < flight.steps; ++k) {
      const Eigen::Vector2d p =
          flight.start + (k + 0.5) * flight.run_m * Eigen::Vector2d(std::cos(flight.yaw), std::sin(flight.yaw));
      const double z = flight.z0_m + (k + 1) * flight.rise_m;
      EXPECT_NEAR(ground.height(p.x(), p.y(), z + 0.3), z, 1e-9);
    }
  const bim::Landing& landing = house().stairs.at(0).landings.at(0);
  EXPECT_NEAR(ground.height(9.22, 4.9, 1.9), landing.z_m, 1e-9);
  EXPECT_EQ(ground.height(2.0, 2.0, 0.5), 0.0);
  // The upper floor: endless far from the well, boxes near it; one does not stand on it from below.
  for (const double x : {1.0, 4.0, 6.0}) {
    EXPECT_NEAR(ground.height(x, 5.4, 3.4), 2.9, 1e-9);
    EXPECT_EQ(ground.height(x, 5.4, 0.5), 0.0);
  }
  EXPECT_EQ(ground.plane_height({1.0, 1.0, 3.4}), 2.9);
  EXPECT_EQ(ground.plane_height({6.2, 5.4, 3.4}), 0.0);
}

TEST(BuildingGround, AStairToAStoreyThatIsNotWalkedIsAnObstacle) {
  EXPECT_TRUE(building_ground(house(), {0}).surfaces().empty());
  const bim::StairFlight& flight = house().stairs.at(0).flights.at(0);
  const Eigen::Vector2d along(std::cos(flight.yaw), std::sin(flight.yaw));
  Eigen::Vector3d in_step;  // half a rise under the middle of the third tread
  in_step << flight.start + 2.5 * flight.run_m * along, flight.z0_m + 2.5 * flight.rise_m;
  const auto touched = [&](const std::vector<int>& storeys) {
    const std::vector<CollisionBox> boxes = collision_boxes(house(), storeys);
    return std::any_of(boxes.begin(), boxes.end(),
                       [&](const CollisionBox& box) { return distance(box, in_step) == 0.0; });
  };
  EXPECT_TRUE(touched({0}));
  EXPECT_FALSE(touched({0, 1}));
  EXPECT_TRUE(is_walked(house().stairs.at(0), {1, 0}));
  EXPECT_FALSE(is_walked(house().stairs.at(0), {0}));
}

TEST(BuildingGround, TheFloorAroundOneWellLeavesItsNeighboursOpen) {
  const bim::Building houses = library_building("s_graphs/c2.plan.yaml");
  const Ground ground = building_ground(houses, {0, 1, 2});
  for (const bim::Stair& stair : houses.stairs)
    for (const bim::StairFlight& flight : stair.flights)
      for (int k = 0; k < flight.steps; ++k) {
        const Eigen::Vector2d p =
            flight.start + (k + 0.5) * flight.run_m * Eigen::Vector2d(std::cos(flight.yaw), std::sin(flight.yaw));
        const double z = flight.z0_m + (k + 1) * flight.rise_m;
        EXPECT_NEAR(ground.height(p.x(), p.y(), z + 1.0), z, 1e-9) << stair.id << ", step " << k;
      }
  for (const double x : {3.0, 7.5, 10.0, 14.5, 18.0}) EXPECT_NEAR(ground.height(x, 5.2, 3.3), 2.8, 1e-9) << x;
}

TEST(BuildingGround, AMissingStoreyIsBadInput) {
  EXPECT_THROW((void)building_ground(house(), {0, 2}), InputError);
  EXPECT_THROW((void)building_ground(house(), {}), InputError);
}

/// Ten steps up to a floor and back down.
TEST(Robot, ClimbsAFlightAndComesDown) {
  constexpr double rise = 0.15;
  constexpr double run = 0.30;
  std::vector<CollisionBox> steps;
  for (int k = 0; k < 10; ++k)
    steps.push_back(
        upright_box({2.0 + (k + 0.5) * run, 0.0}, 0.0, {0.5 * run, 1.0}, {k * rise - 0.15, (k + 1) * rise}));
  steps.push_back(upright_box({7.0, 0.0}, 0.0, {2.0, 2.0}, {1.3, 1.5}));
  Robot robot(Pose::from_xyz_yaw({1.0, 0.0, 0.9}, 0.0), Ground({{0.0, {}}}, steps), {});
  PurePursuit pursuit(
      PurePursuitConfig{},
      {{{1.0, 0.0, 0.0}}, {{5.4, 0.0, 1.5}, true}, {{6.5, 0.0, 1.5}}, {{5.6, 0.0, 1.5}}, {{1.4, 0.0, 0.0}, true}}, 1);
  double z_max = 0.0;
  for (std::int64_t tick = 0; !pursuit.done() && tick < 30000; ++tick) {
    robot.step(pursuit.update(robot.X_WR(), tick));
    z_max = std::max(z_max, robot.X_WR().t.z());
  }
  EXPECT_TRUE(pursuit.done());
  EXPECT_NEAR(z_max, 2.0, 0.1);
  EXPECT_NEAR(robot.X_WR().t.z(), 0.5, 0.1);
}

TEST(BuildingGround, ARaisedFloorAtAnyAngleEndsAtItsEdges) {
  for (const double degrees : {1.1, 11.3, 46.0, 88.8}) {
    const double yaw = degrees * std::numbers::pi / 180.0;
    const Eigen::Rotation2Dd turn(yaw);
    bim::Building building = empty_storey();
    add_room(building, "hall", rectangle({-40, -40}, {40, 40}));
    for (const auto& [id, floor, top] :
         {std::tuple("floor", rectangle({-40, -40}, {40, 40}), 0.0), {"raised", rectangle({-15, -3}, {15, 3}), 0.2}}) {
      bim::Slab slab;
      slab.id = id;
      slab.storey = 0;
      for (const Eigen::Vector2d& p : floor) slab.polygon.outer.push_back(turn * p);
      slab.z0_m = top - 0.2;
      slab.z1_m = top;
      building.slabs.push_back(slab);
    }
    const Ground ground = building_ground(building, {0});
    for (const double x : {-15.02, -14.98, -5.0, 5.0, 14.98, 15.02})
      for (const double y : {-3.02, -2.98, 2.98, 3.02}) {
        const Eigen::Vector2d p = turn * Eigen::Vector2d(x, y);
        const double z = std::abs(x) < 15.0 && std::abs(y) < 3.0 ? 0.2 : 0.0;
        EXPECT_NEAR(ground.height(p.x(), p.y(), 1.0), z, 1e-9) << degrees << ": " << x << " " << y;
      }
  }
}

TEST(BuildingGround, ALandingRoundACornerLeavesTheCornerOpen) {
  bim::Building building = house();
  bim::Landing& landing = building.stairs[0].landings.at(0);
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : landing.polygon) box.extend(p);
  const Eigen::Vector2d low = box.min(), high = box.max(), mid = box.center();
  landing.polygon = {low, {high.x(), low.y()}, {high.x(), mid.y()}, mid, {mid.x(), high.y()}, {low.x(), high.y()}};
  const Ground ground = building_ground(building, {0, 1});
  const auto height = [&](double x, double y) {
    const Eigen::Vector2d p = low + Eigen::Vector2d(x, y).cwiseProduct(high - low);
    return ground.height(p.x(), p.y(), landing.z_m + 0.3);
  };
  for (const auto& [x, y] : {std::pair{0.25, 0.25}, {0.75, 0.25}, {0.25, 0.75}})
    EXPECT_NEAR(height(x, y), landing.z_m, 1e-9) << x << " " << y;
  EXPECT_LT(height(0.75, 0.75), landing.z_m - 0.1);
}

}  // namespace
}  // namespace plumbline::sim
