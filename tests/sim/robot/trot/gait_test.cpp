// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/trot/gait.h"

#include <gtest/gtest.h>

#include "sim/robot/trot/contact.h"

namespace plumbline::sim {
namespace {

constexpr double dt = 0.002;
const GaitDemand walk{.still = false};
const GaitDemand stand{.still = true};

TEST(Gait, StandsUntilAskedToMove) {
  Gait gait{GaitConfig{}};
  for (int i = 0; i < 500; ++i) gait.update(stand, dt);
  EXPECT_TRUE(gait.standing());
  gait.update({.still = true, .disturbed = true}, dt);
  EXPECT_FALSE(gait.standing());
}

TEST(Gait, DiagonalPairsSwingTogetherAndNeverBothPairs) {
  Gait gait{GaitConfig{}};
  int stance = 0;
  constexpr int periods = 20;
  const int steps = static_cast<int>(periods * GaitConfig{}.period_s / dt + 0.5);
  gait.update(walk, dt);
  for (int i = 0; i < steps; ++i) {
    gait.update(walk, dt);
    EXPECT_EQ(gait.scheduled_stance(0), gait.scheduled_stance(3));
    EXPECT_EQ(gait.scheduled_stance(1), gait.scheduled_stance(2));
    EXPECT_TRUE(gait.scheduled_stance(0) || gait.scheduled_stance(1));
    if (gait.scheduled_stance(0)) ++stance;
  }
  EXPECT_NEAR(static_cast<double>(stance) / steps, GaitConfig{}.duty, 1.0 / periods);
}

TEST(Gait, ALongerPeriodTakesLonger) {
  const auto steps_to_first_swing = [](double scale) {
    Gait gait{GaitConfig{}};
    int steps = 0;
    while (gait.scheduled_stance(0) && steps < 1000) {
      gait.update({.still = false, .period_scale = scale}, dt);
      ++steps;
    }
    return steps * dt;
  };
  EXPECT_NEAR(steps_to_first_swing(1.0), 0.56 * 0.44, 2.0 * dt);
  EXPECT_NEAR(steps_to_first_swing(1.5), 0.56 * 0.66, 2.0 * dt);
}

/// More time on the ground; no foot is lifted or set down by the change itself.
TEST(Gait, ChangesToCarefulOnAllFourFeet) {
  const GaitConfig config;
  Gait gait{config};
  gait.update(walk, dt);
  while (gait.scheduled_stance(0)) gait.update(walk, dt);
  const auto stances = [&] {
    PerLeg<bool> out{};
    for (std::size_t leg = 0; leg < leg_count; ++leg) out[leg] = gait.scheduled_stance(leg);
    return out;
  };
  for (const bool slow_gait : {true, false}) {
    while (gait.slow_gait() != slow_gait) {
      const PerLeg<bool> before = stances();
      gait.update({.still = false, .slow_gait = slow_gait}, dt);
      for (std::size_t leg = 0; gait.slow_gait() == slow_gait && leg < leg_count; ++leg)
        EXPECT_TRUE(before[leg] && gait.scheduled_stance(leg)) << leg;
    }
    const double duty = slow_gait ? config.slow_duty : config.duty;
    const double period_s = slow_gait ? config.slow_period_s : config.period_s;
    EXPECT_NEAR(gait.stance_s(), duty * period_s, 1e-12);
    EXPECT_NEAR(gait.swing_s(), (1.0 - duty) * period_s, 1e-12);
  }
}

TEST(Gait, StopsOnAllFourFeetAfterASecondOfCalm) {
  Gait gait{GaitConfig{}};
  for (int i = 0; i < 137; ++i) gait.update(walk, dt);
  int steps = 0;
  bool swung = false;
  while (!gait.standing() && steps < 2000) {
    swung = swung || !gait.scheduled_stance(0);
    gait.update(stand, dt);
    ++steps;
  }
  EXPECT_TRUE(swung);
  EXPECT_GT(steps * dt, 1.0);
  EXPECT_LT(steps * dt, 1.0 + 0.44);
}

TEST(Gait, AFootThatTouchesDownEarlyStands) {
  Gait gait{GaitConfig{}};
  PerLeg<Eigen::Vector3d> foot_W = zero_per_leg();
  PerLeg<LegContact> legs = initial_contacts(foot_W);
  const auto step = [&](double touch) {
    gait.update(walk, dt);
    update_contacts(ContactConfig{}, gait, {touch, 100.0, 100.0, touch}, foot_W, {true, true, true, true}, legs);
  };
  step(100.0);
  while (gait.scheduled_stance(0)) step(100.0);
  EXPECT_TRUE(legs[0].lifted_off);
  EXPECT_TRUE(legs[0].swinging);
  while (gait.swing_progress(0) < 0.7) step(0.0);
  EXPECT_TRUE(legs[0].swinging);
  foot_W[0].x() = 0.25;
  step(20.0);
  EXPECT_TRUE(legs[0].early);
  EXPECT_FALSE(legs[0].swinging);
  EXPECT_EQ(legs[0].last_stance_W.x(), 0.25);
}

TEST(Gait, ContactHasHysteresis) {
  const Gait gait{GaitConfig{}};
  PerLeg<LegContact> legs = initial_contacts(zero_per_leg());
  const auto contact_at = [&](double touch) {
    update_contacts(ContactConfig{}, gait, {touch, 0.0, 0.0, 0.0}, zero_per_leg(), {true, true, true, true}, legs);
    return legs[0].contact;
  };
  EXPECT_TRUE(contact_at(3.0));
  EXPECT_FALSE(contact_at(1.0));
  EXPECT_FALSE(contact_at(7.0));
  EXPECT_TRUE(contact_at(9.0));
}

}  // namespace
}  // namespace plumbline::sim
