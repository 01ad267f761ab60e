// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/leg_height.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/robot/physics_step.h"

namespace plumbline::sim {
namespace {

constexpr double base_m = 0.5;
constexpr std::array<bool, 4> all = {true, true, true, true};
constexpr std::array<bool, 4> one_pair = {false, true, true, false};
constexpr std::array<bool, 4> other_pair = {true, false, false, true};

/// A level base that accelerates along z, and the ground under its feet.
struct Bench {
  LegHeight height{LegHeightConfig{}};
  double z_m = base_m;
  double climb_mps = 0.0;

  void run(int steps, double acceleration, const std::array<double, 4>& ground_m, const std::array<bool, 4>& contact) {
    for (int i = 0; i < steps; ++i) {
      climb_mps += acceleration * step_s;
      z_m += climb_mps * step_s;
      SensorReading reading;
      reading.contact = contact;
      reading.accelerometer_R.z() = LegHeightConfig{}.gravity + acceleration;
      std::array<double, 4> sole_m{};
      for (std::size_t leg = 0; leg < sole_m.size(); ++leg) sole_m[leg] = ground_m[leg] - z_m;
      height.update(reading, Eigen::Quaterniond::Identity(), sole_m, {}, step_s);
    }
  }
  [[nodiscard]] double error() const { return height.z() - (z_m - base_m); }
};

TEST(LegHeight, SeesAStepAndAPebble) {
  for (const double step_m : {0.17, 0.02, -0.10}) {
    Bench bench;
    bench.run(100, 0.0, {}, all);
    bench.run(100, 0.0, {step_m, 0.0, 0.0, step_m}, one_pair);
    bench.run(100, 0.0, {step_m, 0.0, 0.0, step_m}, all);
    bench.run(100, 0.0, {step_m, step_m, step_m, step_m}, other_pair);
    bench.run(250, step_m / 0.25, {step_m, step_m, step_m, step_m}, all);
    bench.run(250, -step_m / 0.25, {step_m, step_m, step_m, step_m}, all);
    EXPECT_NEAR(bench.z_m - base_m, step_m, 1e-9);
    EXPECT_NEAR(bench.error(), 0.0, 1e-9) << step_m;
  }
}

/// A pair lands 3 mm deep and springs back before it is taken as still.
TEST(LegHeight, DoesNotTakeTheSpringOfALandingForAClimb) {
  Bench bench;
  bench.run(100, 0.0, {}, all);
  for (int stride = 0; stride < 20; ++stride)
    for (const std::array<bool, 4>& pair : {one_pair, other_pair}) {
      for (int i = 0; i < 25; ++i) {
        const double sunk = -0.003 * std::exp(-i / 5.0);
        bench.run(1, 0.0, {pair[0] ? sunk : 0.0, pair[1] ? sunk : 0.0, pair[2] ? sunk : 0.0, pair[3] ? sunk : 0.0},
                  i < 10 ? all : pair);
      }
      bench.run(100, 0.0, {}, pair);
    }
  EXPECT_NEAR(bench.error(), 0.0, 1e-3);  // 40 landings; the sunk feet would make it 40 x 0.4 mm or more
}

TEST(LegHeight, AFlippedFlagIsNoLift) {
  Bench bench;
  bench.run(100, 0.0, {}, all);
  for (int i = 0; i < 100; ++i) {
    bench.run(2, 0.0, {}, {true, false, true, true});
    bench.run(1, 0.0, {}, all);
    EXPECT_TRUE(bench.height.held()) << i;
  }
  bench.run(3, 0.0, {}, {true, false, true, true});
  bench.run(1, 0.0, {}, all);
  EXPECT_FALSE(bench.height.held());
}

/// With no foot on the ground the accelerometer carries the height exactly.
TEST(LegHeight, FliesByTheAccelerometer) {
  Bench bench;
  bench.run(100, 0.0, {}, all);
  bench.run(50, 3.0, {}, {});
  EXPECT_FALSE(bench.height.held());
  bench.run(50, -9.81, {}, {});
  EXPECT_NEAR(bench.error(), 0.0, 1e-9);
}

/// Errors of the climb rate die out once feet stand.
TEST(LegHeight, StandingStopsADrift) {
  Bench bench;
  bench.run(100, 0.0, {}, all);
  for (int i = 0; i < 100; ++i) {
    SensorReading kick;
    kick.accelerometer_R.z() = LegHeightConfig{}.gravity + 0.5;
    kick.contact = all;
    bench.height.update(kick, Eigen::Quaterniond::Identity(), {-base_m, -base_m, -base_m, -base_m}, {}, step_s);
  }
  EXPECT_GT(std::abs(bench.error()), 5e-4);  // steady: 0.5 m/s^2 over the bandwidth squared
  EXPECT_LT(std::abs(bench.error()), 5e-3);
  bench.run(1000, 0.0, {}, all);
  EXPECT_NEAR(bench.error(), 0.0, 1e-6);
}

}  // namespace
}  // namespace plumbline::sim
