// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/read/stair_recognition.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bim/model/extrude.h"

namespace plumbline::bim {
namespace {

/// Box with one corner at the origin of a frame that stands at `at`, turned by `yaw`.
Solid box(const Eigen::Vector2d& at, double yaw, double x0, double x1, double y0, double y1, double z0, double z1) {
  const Eigen::Vector2d u(std::cos(yaw), std::sin(yaw)), v(-u.y(), u.x());
  Solid solid = extrude(unite(std::vector<Polygon2>{{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}}), z0, z1);
  for (Eigen::Vector3d& p : solid.vertices) p.head<2>() = at + p.x() * u + p.y() * v;
  return solid;
}

struct Straight {
  Eigen::Vector2d at = {3.0, -2.0};
  double yaw = 0.0, rise = 0.18, run = 0.27, width = 1.1, z0 = 0.5;
  int steps = 9;
};

/// Steps as full blocks one upon the other: each covers all that is behind it.
std::vector<Solid> blocks(const Straight& s) {
  std::vector<Solid> solids;
  for (int k = 0; k < s.steps; ++k)
    solids.push_back(box(s.at, s.yaw, k * s.run, s.steps * s.run, -s.width / 2, s.width / 2, s.z0 + k * s.rise,
                         s.z0 + (k + 1) * s.rise));
  return solids;
}

/// Open treads that overhang the one below by 30 mm.
std::vector<Solid> boards(const Straight& s) {
  std::vector<Solid> solids;
  for (int k = 0; k < s.steps; ++k)
    solids.push_back(box(s.at, s.yaw, k * s.run, (k + 1) * s.run + 0.03, -s.width / 2, s.width / 2,
                         s.z0 + (k + 1) * s.rise - 0.04, s.z0 + (k + 1) * s.rise));
  return solids;
}

void expect_straight(const RecognizedStair& shape, const Straight& s) {
  ASSERT_EQ(shape.flights.size(), 1u);
  const StairFlight& flight = shape.flights.front();
  EXPECT_EQ(flight.steps, s.steps);
  EXPECT_NEAR(flight.rise_m, s.rise, 1e-4);
  EXPECT_NEAR(flight.run_m, s.run, 1e-3);
  EXPECT_NEAR(flight.width_m, s.width, 1e-3);
  EXPECT_NEAR(flight.z0_m, s.z0, 1e-3);
  EXPECT_NEAR(std::remainder(flight.yaw - s.yaw, 2.0 * M_PI), 0.0, 1e-3);
  EXPECT_NEAR((flight.start - s.at).norm(), 0.0, 2e-3);
}

TEST(RecognizedStair, FindsAStraightFlightWhicheverWayItRuns) {
  for (const double yaw : {0.0, 0.4, 1.5707963, 2.5, -2.9, -0.7}) {
    Straight s;
    s.yaw = yaw;
    expect_straight(recognize_stair(blocks(s)), s);
    expect_straight(recognize_stair(boards(s)), s);
  }
}

TEST(RecognizedStair, TwoStepsAreAFlight) {
  Straight s;
  s.steps = 2;
  expect_straight(recognize_stair(blocks(s)), s);
}

/// Up along x, a landing across both flights, back along -x.
TEST(RecognizedStair, DogLegHasALandingBetweenTwoFlights) {
  const Straight up;
  Straight back = up;
  back.at = {up.at.x() + up.steps * up.run, up.at.y() + 1.2};
  back.yaw = M_PI;
  back.z0 = up.z0 + (up.steps + 1) * up.rise;
  std::vector<Solid> solids = boards(up);
  const double top = back.z0;
  solids.push_back(box(back.at, 0.0, 0.0, 1.2, -1.75, 0.55, top - 0.2, top));
  for (Solid& solid : boards(back)) solids.push_back(std::move(solid));
  const RecognizedStair shape = recognize_stair(solids);
  ASSERT_EQ(shape.flights.size(), 2u);
  ASSERT_EQ(shape.landings.size(), 1u);
  EXPECT_NEAR(shape.landings.front().z_m, top, 1e-4);
  EXPECT_NEAR(signed_area(shape.landings.front().polygon), 1.2 * 2.3, 1e-2);
  EXPECT_EQ(shape.flights[0].steps, up.steps);
  EXPECT_EQ(shape.flights[1].steps, back.steps);
  EXPECT_NEAR(shape.flights[1].z0_m, top, 1e-3);
  EXPECT_NEAR(std::abs(shape.flights[1].yaw), M_PI, 1e-3);
}

/// A winding stair: single steps that rise evenly and turn.
TEST(RecognizedStair, WindingStairIsARowOfShortFlights) {
  std::vector<Solid> solids;
  const double turn = 0.3, rise = 0.18;
  for (int k = 0; k < 12; ++k) solids.push_back(box({0, 0}, k * turn, 0.3, 1.2, -0.13, 0.13, k * rise, (k + 1) * rise));
  const RecognizedStair shape = recognize_stair(solids);
  ASSERT_EQ(shape.flights.size(), 12u);
  for (std::size_t k = 0; k < shape.flights.size(); ++k) {
    EXPECT_EQ(shape.flights[k].steps, 1);
    EXPECT_NEAR(shape.flights[k].rise_m, rise, 1e-6);
    EXPECT_NEAR(shape.flights[k].z0_m, static_cast<double>(k) * rise, 1e-4);
  }
  const double heading = shape.flights[6].yaw - (6 * turn + M_PI / 2);
  EXPECT_NEAR(std::remainder(heading, 2.0 * M_PI), 0.0, 0.1);
}

TEST(RecognizedStair, ARampHasNoSteps) {
  Solid ramp = box({0, 0}, 0.0, 0.0, 4.0, -0.6, 0.6, 0.0, 0.1);
  for (Eigen::Vector3d& p : ramp.vertices) p.z() += 0.1 * p.x();
  EXPECT_TRUE(recognize_stair({ramp}).flights.empty());
  EXPECT_TRUE(recognize_stair({}).flights.empty());
}

}  // namespace
}  // namespace plumbline::bim
