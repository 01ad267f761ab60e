// SPDX-License-Identifier: Apache-2.0
#include "slam/particles/particles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/slam/localization/house_plan.h"
#include "tests/slam/plan_map/wall_log_likelihood.h"

namespace plumbline::slam {
namespace {

PlanIndex corridor_index() { return make_plan_index(synthetic::plan_of(synthetic::corridor_house()), "ground", {}); }

LocalizationScan scan_at(const synthetic::House& house, const Pose& X_WR) {
  const synthetic::WalkConfig config;
  const Scan scan = synthetic::standing_scan(house, X_WR, config);
  MotionBuffer motion;
  motion.add({0, Pose{}});
  const DeskewedScan deskewed = deskew(scan, motion, synthetic::calibration());
  return make_localization_scan(deskewed, detect_planes(deskewed, {}), Pose{}, synthetic::calibration(), {});
}

TEST(Particles, StartUniformlyInTheRoomsOnly) {
  const PlanIndex index = corridor_index();
  StartPrior prior;
  prior.yaw_I = 1.0;
  const ParticleSet particles = sample_initial_particles(index, prior, LocalizationScan{}, {}, 7, 1);
  const StoreyIndex& storey = index.storeys.front();
  std::vector<double> per_room(storey.rooms.size(), 0.0);
  double yaw = 0.0;
  for (const LocalParticle& particle : particles) {
    const int room = storey.room_at(particle.X_IH.t);
    ASSERT_GE(room, 0);
    per_room[static_cast<std::size_t>(room)] += 1.0;
    yaw += particle.X_IH.yaw / static_cast<double>(particles.size());
  }
  // 1 draw in 1/30 m^2; the strip of 0.25 m along the walls stays empty.
  for (std::size_t i = 0; i < per_room.size(); ++i) {
    const double area = std::abs(signed_area(storey.rooms[i].polygon));
    EXPECT_GT(per_room[i] / area, 15.0);
    EXPECT_LT(per_room[i] / area, 30.0);
  }
  EXPECT_NEAR(yaw, 1.0, 4.0 * prior.yaw_sigma / std::sqrt(static_cast<double>(particles.size())));
}

TEST(Particles, WhoWalksThroughAWallDies) {
  const PlanIndex index = make_plan_index(synthetic::plan_of(synthetic::one_room(6.0, 4.0)), "ground", {});
  const Eigen::Vector2d center = centroid(index.storeys.front().rooms.front().polygon);
  ParticleSet particles{{{center, 0.0}, 0, 0.5, -1}, {{center, 0.0}, 0, 0.5, -1}};
  particles[1].X_IH.t.x() += 2.6;
  FilterConfig exact;
  exact.trans_per_m = exact.trans_per_rad_m = exact.rot_per_m = exact.rot_per_rad = 0.0;
  propagate(particles, {{1.0, 0.0}, 0.0}, index, exact, 7, 2);
  EXPECT_EQ(particles[1].weight, 0.0);
  EXPECT_EQ(particles[0].weight, 1.0);
  EXPECT_NEAR((particles[0].X_IH.t - center).x(), 1.0, 1e-12);
}

TEST(Particles, MotionNoiseHasThePromisedSpread) {
  const PlanIndex index = make_plan_index(synthetic::plan_of(synthetic::one_room(6.0, 4.0)), "ground", {});
  const Eigen::Vector2d center = centroid(index.storeys.front().rooms.front().polygon);
  ParticleSet particles(4000, {{center, 0.0}, 0, 1.0, -1});
  const FilterConfig config;
  propagate(particles, {{0.5, 0.0}, 0.2}, index, config, 7, 2);
  double xx = 0.0, yaw2 = 0.0;
  for (const LocalParticle& p : particles) {
    xx += std::pow(p.X_IH.t.x() - center.x() - 0.5, 2) / 4000.0;
    yaw2 += std::pow(p.X_IH.yaw - 0.2, 2) / 4000.0;
  }
  // Spread of a sample standard deviation of 4000: 1.1 %; 5 % is more than 4 of those.
  EXPECT_NEAR(std::sqrt(xx), std::hypot(0.5 * config.trans_per_m, 0.2 * config.trans_per_rad_m), 0.05 * 0.0254);
  EXPECT_NEAR(std::sqrt(yaw2), std::hypot(0.2 * config.rot_per_rad, 0.5 * config.rot_per_m), 0.05 * 0.0095);
}

TEST(Particles, TemperingKeepsAShareEffective) {
  const synthetic::House house = synthetic::corridor_house();
  const PlanIndex index = corridor_index();
  const LocalizationScan scan = scan_at(house, Pose::from_xyz_yaw({7.0, 1.1, 0.46}, 0.3));
  ParticleSet particles = sample_initial_particles(index, {0.3, 0.05}, scan, {}, 7, 1);
  const double n = static_cast<double>(particles.size());
  const Reweighting weighting = reweight(particles, scan, index, {}, {});
  EXPECT_LT(weighting.temper, 1.0);
  EXPECT_NEAR(weighting.effective, 0.1 * n, 0.01 * n);
}

TEST(Particles, TemperingTakesTheLargestExponentThatLeavesSoMany) {
  const Stream stream(5, "slam.localize.init");
  for (const std::uint32_t n : {1U, 6U, 4001U}) {
    ParticleSet particles(n);
    std::vector<double> logs;
    for (std::uint32_t i = 0; i < n; ++i) {
      // A third without weight: they walked through a wall, and nothing was looked up for them.
      particles[i].weight = i % 3 == 2 ? 0.0 : 0.5 + stream.uniform(0, i, 0);
      logs.push_back(i % 3 == 2 ? -1e300 : -300.0 * stream.uniform(0, i, 1));
    }
    normalise(particles);
    const double top = *std::max_element(logs.begin(), logs.end());
    const auto size = [&](double a) {
      double sum = 0.0, squares = 0.0;
      for (std::uint32_t i = 0; i < n; ++i) {
        const double w = particles[i].weight * std::exp(a * (logs[i] - top));
        sum += w;
        squares += w * w;
      }
      return sum * sum / squares;
    };
    const double floor = 0.1 * n, a = temper(particles, logs, top, floor);
    // Single precision: 1e-6 of an exponent of 50, in each weight.
    EXPECT_GE(size(a), floor * (1.0 - 1e-4));
    EXPECT_TRUE(a == 1.0 || size(a + 1e-3) <= floor * (1.0 + 1e-4));
  }
}

TEST(Particles, WhoDiedStaysDead) {
  const synthetic::House house = synthetic::corridor_house();
  const PlanIndex index = corridor_index();
  const LocalizationScan scan = scan_at(house, Pose::from_xyz_yaw({7.0, 1.1, 0.46}, 0.3));
  ParticleSet particles = sample_initial_particles(index, {0.3, 0.05}, scan, {}, 7, 1), without;
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (i % 3 == 0)
      particles[i].weight = 0.0;
    else
      without.push_back(particles[i]);
  FilterConfig config;
  config.ess_floor = 0.0;
  static_cast<void>(reweight(particles, scan, index, {}, config));
  static_cast<void>(reweight(without, scan, index, {}, config));
  std::size_t next = 0;
  for (std::size_t i = 0; i < particles.size(); ++i)
    EXPECT_NEAR(particles[i].weight, i % 3 == 0 ? 0.0 : without[next++].weight, 1e-12);
}

TEST(Particles, TheTruePlaceIsTheMostLikely) {
  const synthetic::House house = synthetic::corridor_house();
  const PlanIndex index = corridor_index();
  const Pose X_WR = Pose::from_xyz_yaw({3.1, 0.9, 0.46}, 0.3);
  const LocalizationScan scan = scan_at(house, X_WR);
  const Pose X_IR = index.X_WI.inverse() * X_WR;
  const StoreyIndex& storey = index.storeys.front();
  const auto log_likelihood = [&](const Pose2& X) {
    return wall_log_likelihood(storey, X, scan, {}) + beam_log_likelihood(storey, X, scan, 1, {});
  };
  const double at_truth = log_likelihood(heading(X_IR));
  int better = 0;
  for (const LocalParticle& p : sample_initial_particles(index, {heading(X_IR).yaw, 0.05}, scan, {}, 7, 1))
    if ((p.X_IH.t - X_IR.t.head<2>()).norm() > 0.3 && log_likelihood(p.X_IH) >= at_truth) ++better;
  EXPECT_EQ(better, 0);
}

}  // namespace
}  // namespace plumbline::slam
