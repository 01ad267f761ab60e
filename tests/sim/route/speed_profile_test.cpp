// SPDX-License-Identifier: Apache-2.0
#include "sim/route/speed_profile.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bim/random/stream.h"

namespace plumbline::sim {
namespace {

SpeedConfig at(double speed_mps) {
  SpeedConfig config;
  config.speed_mps = speed_mps;
  return config;
}

TEST(SpeedProfile, AnOpenStraightWayIsWalkedAtFullSpeed) {
  const SpeedProfile profile(at(1.2), on_floor({{0, 0}, {4, 0}, {8, 0}}, 0.0));
  EXPECT_EQ(profile.limit(1, 4.0), 1.2);
  EXPECT_EQ(profile.limit(1, 0.0), 1.2);
  EXPECT_EQ(profile.limit(2, 4.0), 1.2);
}

TEST(SpeedProfile, SharperBendsAreTakenSlower) {
  double before = 1.2;
  for (const double bend : {0.3, 0.6, 1.0, 1.5, 2.5, 3.1}) {
    const Eigen::Vector2d end(4.0 + 4.0 * std::cos(bend), 4.0 * std::sin(bend));
    const SpeedProfile profile(at(1.2), on_floor({{0, 0}, {4, 0}, end}, 0.0));
    EXPECT_LE(profile.limit(1, 0.0), before) << bend;
    EXPECT_GE(profile.limit(1, 0.0), 0.25);
    EXPECT_EQ(profile.limit(1, 4.0), 1.2);
    before = profile.limit(1, 0.0);
  }
  EXPECT_EQ(before, 0.25);
}

TEST(SpeedProfile, NarrowPlacesAndStairsAreSlow) {
  std::vector<Waypoint> way = on_floor({{0, 0}, {4, 0}, {5, 0}, {9, 0}}, 0.0);
  way[2].clearance_m = 0.4;
  const SpeedProfile narrow(at(1.2), way);
  EXPECT_NEAR(narrow.limit(2, 1.0), (0.4 - 0.25) / 0.25, 1e-12);
  EXPECT_NEAR(narrow.limit(1, 0.0), (0.4 - 0.25) / 0.25, 1e-12);
  EXPECT_EQ(narrow.limit(3, 4.0), 1.2);
  way[2].clearance_m = 0.3;
  EXPECT_EQ(SpeedProfile(at(1.2), way).limit(2, 1.0), 0.3);
  way[2].stairs = true;
  way[2].clearance_m = 9.0;
  EXPECT_EQ(SpeedProfile(at(1.2), way).limit(2, 1.0), SpeedConfig().stairs_mps);
  EXPECT_EQ(SpeedProfile(at(0.2), way).limit(2, 1.0), 0.2);
}

/// Whatever the way, braking at the configured rate keeps every limit ahead.
TEST(SpeedProfile, EveryLimitAheadCanBeKeptByBraking) {
  const Stream stream(5, "bim.generate");
  for (std::uint64_t i = 0; i < 200; ++i) {
    std::vector<Waypoint> way = on_floor({{0, 0}}, 0.0);
    for (std::uint32_t k = 0; k < 12; ++k) {
      const auto draw = [&](std::uint32_t n) { return stream.uniform(i, k, n); };
      const Eigen::Vector3d step(2.0 * draw(0) - 1.0, 2.0 * draw(1) - 1.0, 0.0);
      way.push_back({way.back().p_W + step, draw(2) < 0.2, 0.3 + draw(3)});
    }
    const SpeedConfig config = at(1.2);
    const SpeedProfile profile(config, way);
    for (std::size_t k = 1; k + 1 < way.size(); ++k) {
      const double next_leg = (way[k + 1].p_W - way[k].p_W).norm();
      const double here = profile.limit(k, 0.0), there = profile.limit(k + 1, 0.0);
      EXPECT_LE(here * here, there * there + 2.0 * config.braking * next_leg + 1e-9);
      EXPECT_LE(here, profile.limit(k + 1, next_leg) + 1e-12);
      EXPECT_GE(here, 0.25);
    }
  }
}

TEST(SpeedProfile, WaysOfNoLengthDoNoHarm) {
  EXPECT_NO_THROW(SpeedProfile(at(0.6), {}));
  EXPECT_NO_THROW(SpeedProfile(at(0.6), on_floor({{0, 0}}, 0.0)));
  const SpeedProfile profile(at(0.6), on_floor({{0, 0}, {0, 0}, {1, 0}}, 0.0));
  EXPECT_EQ(profile.limit(1, 0.0), 0.6);
}

}  // namespace
}  // namespace plumbline::sim
