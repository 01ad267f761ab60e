// SPDX-License-Identifier: Apache-2.0
#include "sim/moving/dynamic_obstacles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "bim/errors.h"

namespace plumbline::sim {
namespace {

constexpr slam::Nanoseconds tick_ns = 2'000'000;
const Eigen::Vector3d far_away(100.0, 0.0, 0.0);

PersonConfig person(std::vector<Eigen::Vector3d> points) {
  PersonConfig config;
  config.points_W = std::move(points);
  config.speed_mps = 1.0;
  return config;
}

SwingDoorConfig door(std::vector<double> times) {
  SwingDoorConfig config;
  config.hinge_W = {1.0, 0.0, 0.0};
  config.swing = -1.5;
  config.times_s = std::move(times);
  return config;
}

/// Steps to a time with the robot at one place.
void step_to(DynamicObstacles& things, slam::Nanoseconds& t, double time_s, const Eigen::Vector3d& robot_W) {
  for (; 1e-9 * static_cast<double>(t) <= time_s + 1e-9; t += tick_ns) things.step(t, robot_W);
}

Eigen::Vector3d place(const DynamicObstacles& things) { return things.bodies()[0].stations.back().position_W; }

TEST(DynamicObstacles, PeopleWalkToTheEndAndBackAtTheirSpeed) {
  DynamicObstacles things({person({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}})}, {}, 50);
  slam::Nanoseconds t = 0;
  const std::vector<std::pair<double, Eigen::Vector3d>> expected = {
      {0.0, {0, 0, 0}}, {1.0, {1, 0, 0}}, {2.5, {2, 0.5, 0}}, {3.5, {2, 0.5, 0}},
      {5.0, {1, 0, 0}}, {7.0, {1, 0, 0}}, {12.0, {0, 0, 0}}};
  for (const auto& [time_s, p] : expected) {
    step_to(things, t, time_s, far_away);
    EXPECT_NEAR((place(things) - p).norm(), 0.0, 1e-6) << time_s;
  }
  EXPECT_EQ(things.bodies()[0].element, 50);
}

TEST(DynamicObstacles, PeopleStandStillWhileTheRobotIsNear) {
  DynamicObstacles things({person({{0, 0, 0}, {10, 0, 0}})}, {}, 0);
  slam::Nanoseconds t = 0;
  step_to(things, t, 5.0, {3.0, 0.5, 0.4});
  EXPECT_NEAR((place(things).head<2>() - Eigen::Vector2d(3.0, 0.5)).norm(), DynamicObstacles::keep_away_m, 0.01);
  step_to(things, t, 6.0, far_away);
  EXPECT_NEAR(place(things).x(), 3.0 - std::sqrt(0.75) + 1.0, 0.01);
}

TEST(DynamicObstacles, NobodyBeginsInTheRobot) {
  DynamicObstacles things(
      {person({{0, 0, 0}, {2, 0, 0}, {2, 3, 0}}), person({{0, 0, 0}}), person({{5, 0, 0}, {6, 0, 0}})}, {}, 0);
  const Eigen::Vector3d robot_W(0.2, 0.0, 0.4);
  things.step(0, robot_W);
  const auto apart_m = [&](std::size_t who) {
    return (things.bodies()[who].stations.front().position_W - robot_W).head<2>().norm();
  };
  EXPECT_NEAR(apart_m(0), DynamicObstacles::keep_away_m, 0.11) << "it begins a step farther than near";
  EXPECT_GE(apart_m(0), DynamicObstacles::keep_away_m);
  EXPECT_NEAR(apart_m(1), 0.25 + DynamicObstacles::aside_m, 1e-9) << "it has no other place, and steps aside";
  EXPECT_NEAR(apart_m(2), 4.8, 1e-9);
}

/// The robot walks on through the place of one who stands: the LiDAR is never within a person, who does not leap.
TEST(DynamicObstacles, PeopleStepAside) {
  DynamicObstacles things({person({{2.0, 0.05, 0.0}})}, {}, 0);
  const double least_m = 0.25 + DynamicObstacles::aside_m;
  slam::Nanoseconds t = 0;
  Eigen::Vector3d before(2.0, 0.05, 0.0);
  constexpr double robot_mps = 0.6, step_m = robot_mps * 2e-3;
  for (double x = 0.0; x < 6.0; x += step_m, t += tick_ns) {
    things.step(t, {x, 0.0, 0.4});
    const Eigen::Vector3d now = place(things);
    EXPECT_GE((now - Eigen::Vector3d(x, 0.0, 0.0)).head<2>().norm(), least_m - 1e-9);
    EXPECT_LT((now - before).norm(), 6e-3) << "faster than 3 m/s at " << x;
    before = now;
  }
  EXPECT_NEAR((before - Eigen::Vector3d(2.0, 0.05, 0.0)).norm(), 0.0, 1e-9) << "back in its place";
}

TEST(DynamicObstacles, PeopleOfOnePlaceOrOfNoWayStand) {
  DynamicObstacles things({person({{1, 2, 0}}), person({{1, 2, 0}, {1, 2, 0}})}, {}, 0);
  slam::Nanoseconds t = 0;
  step_to(things, t, 1.0, far_away);
  for (const bim::MovingBody& body : things.bodies())
    EXPECT_EQ(body.stations.back().position_W, Eigen::Vector3d(1, 2, 0));
  EXPECT_THROW(DynamicObstacles({person({})}, {}, 0), InternalError);
}

TEST(DynamicObstacles, DoorsKeepTheirTimesAndOpenForTheRobot) {
  DynamicObstacles things({}, {door({2.0, 5.0})}, 7);
  slam::Nanoseconds t = 0;
  const auto yaw = [&] { return things.bodies()[0].stations.back().yaw; };
  step_to(things, t, 2.0, far_away);
  EXPECT_NEAR(yaw(), 0.0, 0.01);
  step_to(things, t, 2.5, far_away);
  EXPECT_NEAR(yaw(), -0.75, 0.01);
  step_to(things, t, 4.0, far_away);
  EXPECT_NEAR(yaw(), -1.5, 1e-9);
  step_to(things, t, 6.5, far_away);
  EXPECT_NEAR(yaw(), 0.0, 1e-9);
  step_to(things, t, 7.2, {1.5, 1.0, 0.4});
  EXPECT_LT(yaw(), -0.9);
  step_to(things, t, 9.0, {1.5, 1.0, 3.4});  // on the storey above
  EXPECT_NEAR(yaw(), 0.0, 1e-9);
}

TEST(DynamicObstacles, ForgetsWhatIsPast) {
  DynamicObstacles things({person({{0, 0, 0}, {10, 0, 0}})}, {door({})}, 0);
  slam::Nanoseconds t = 0;
  step_to(things, t, 1.0, far_away);
  things.forget_before(901'000'000);
  for (const bim::MovingBody& body : things.bodies()) {
    EXPECT_LE(body.stations.size(), 52U);
    EXPECT_LE(body.stations.front().time_s, 0.901);
    EXPECT_GT(body.stations[1].time_s, 0.901);
  }
}

TEST(DynamicObstacles, PeopleWalkOnWhileTheRobotIsOnAnotherStorey) {
  DynamicObstacles things({person({{0, 0, 3}, {10, 0, 3}})}, {}, 0);
  slam::Nanoseconds t = 0;
  step_to(things, t, 5.0, {3.0, 0.5, 0.4});
  EXPECT_NEAR(place(things).x(), 5.0, 0.01);
  step_to(things, t, 8.0, {5.8, 0.0, 3.4});
  EXPECT_NEAR(place(things).x(), 5.0, 0.01) << "on its own";
}

}  // namespace
}  // namespace plumbline::sim
