// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "slam/localization/compare_hypotheses.h"
#include "slam/localization/global_localizer.h"

namespace plumbline::slam {
namespace {

HypothesisComparisonConfig with_caps(double object_cap, double cause_cap) {
  HypothesisComparisonConfig config;
  config.object_cap = config.outlined_cap = object_cap;
  config.cause_cap = config.missing_wall_cap = cause_cap;
  return config;
}

/// Evidence of beams that ended within a box of at least 0.4 m each way, and are spread over it.
EvidenceByCause::Sum seen_in(double log_likelihood, const Eigen::AlignedBox2d& within) {
  EvidenceByCause::Sum sum{log_likelihood, 0.0, 0.0, within};
  const Eigen::Vector2d centre = within.center(), spread = (0.5 * within.sizes()).cwiseMax(0.2);
  sum.ends = log_likelihood * centre;
  sum.ends2 = log_likelihood * (centre * centre.transpose() + Eigen::Matrix2d(spread.cwiseAbs2().asDiagonal()));
  return sum;
}

TEST(EvidenceByCause, NoCauseCountsForMoreThanTheCap) {
  const OutlierCause wall{OutlierCause::Kind::not_built, 3}, before{OutlierCause::Kind::in_front_of_face, 3},
      thing{OutlierCause::Kind::unplanned, 3, 1};
  EvidenceByCause evidence, more;
  for (int i = 0; i < 10; ++i) evidence.add(wall, 1.0);
  evidence.add(before, 1.0);
  evidence.add(thing, 2.0);
  EXPECT_EQ(evidence.total(with_caps(100.0, 100.0)), 13.0);
  EXPECT_EQ(evidence.total(with_caps(4.0, 4.0)), 7.0);
  more.add({OutlierCause::Kind::unplanned, 3, 2}, 6.0);
  evidence.add(more, 0.5);
  EXPECT_EQ(evidence.total(with_caps(4.0, 4.0)), 10.0);
  EXPECT_EQ(evidence.total(with_caps(2.0, 4.0)), 1.0 + 2.0 + 2.0 + 4.0);
  evidence.clear();
  EXPECT_EQ(evidence.total(with_caps(4.0, 4.0)), 0.0);
}

TEST(EvidenceByCause, ARailingDoesNotDecide) {
  const HypothesisComparisonConfig config;
  const OutlierCause railing{OutlierCause::Kind::between_bars, 3}, wall{OutlierCause::Kind::not_built, 4};
  const Eigen::AlignedBox2d seen_behind(Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(5.0, 3.0));
  EvidenceByCause evidence;
  evidence.add(railing, seen_in(50.0, seen_behind));
  EXPECT_EQ(evidence.total(config), config.object_cap);
  evidence.add(wall, seen_in(50.0, seen_behind));
  EXPECT_EQ(evidence.total(config), config.object_cap + config.cause_cap);
}

TEST(EvidenceByCause, AMissingWallDecidesOnlyWithOthers) {
  const HypothesisComparisonConfig config;
  const OutlierCause wall{OutlierCause::Kind::not_built, 3}, other{OutlierCause::Kind::not_built, 4},
      thing{OutlierCause::Kind::unplanned, 3, 1};
  EvidenceByCause evidence;
  evidence.add(wall, 50.0, 40.0);
  EXPECT_EQ(evidence.total(config), config.missing_wall_cap);
  EXPECT_LT(evidence.total(config), ConvergenceConfig{}.log_ratio);
  EvidenceByCause with_thing = evidence;
  with_thing.add(thing, 1.0);
  EXPECT_EQ(with_thing.total(config), config.missing_wall_cap + 1.5);
  evidence.add(other, 50.0, 50.0);
  EXPECT_EQ(evidence.total(config), 2.0 * config.cause_cap) << "two walls are missing";
}

TEST(EvidenceByCause, FrontsOfCupboardsDecideOnlyWithOthers) {
  const HypothesisComparisonConfig config;
  const auto before = [](double depth_m, double sigma_m, double y) {
    EvidenceByCause::Sum sum = seen_in(50.0, {Eigen::Vector2d(0.0, y), Eigen::Vector2d(3.0, y)});
    sum.before_m = 50.0 * depth_m;
    sum.before_m2 = 50.0 * (depth_m * depth_m + sigma_m * sigma_m);
    return sum;
  };
  const auto cause = [](int wall) { return OutlierCause{OutlierCause::Kind::in_front_of_face, wall, 2}; };
  EvidenceByCause fronts;
  fronts.add(cause(1), before(0.6, 0.02, 0.0));
  EXPECT_EQ(fronts.total(config), config.front_cap);
  fronts.add(cause(2), before(0.35, 0.02, 5.0));
  EXPECT_EQ(fronts.total(config), config.front_cap) << "what one flat has in one room it has in others";
  EXPECT_LT(fronts.total(config), ConvergenceConfig{}.log_ratio);
  fronts.add({OutlierCause::Kind::unplanned, 9, 9}, 2.0);
  EXPECT_EQ(fronts.total(config), config.front_cap + 3.0);
  for (const auto& [depth_m, sigma_m] : {std::pair(1.5, 0.02), std::pair(0.1, 0.02), std::pair(0.5, 0.2)}) {
    EvidenceByCause other;
    other.add(cause(1), before(depth_m, sigma_m, 0.0));
    EXPECT_GT(other.total(config), ConvergenceConfig{}.log_ratio) << depth_m << " " << sigma_m;
  }
}

/// Beams that ended along a line, each as likely.
EvidenceByCause::Sum seen_along(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double bulge_m = 0.0) {
  EvidenceByCause::Sum sum;
  const Eigen::Vector2d along = (to - from).normalized(), across(-along.y(), along.x());
  for (int i = 0; i <= 20; ++i) {
    const Eigen::Vector2d end = from + 0.05 * i * (to - from) + (i % 2) * bulge_m * across;
    sum.log_likelihood += 1.0;
    sum.within.extend(end);
    sum.ends += end;
    sum.ends2 += end * end.transpose();
  }
  return sum;
}

// A pose may have a wall by chance where a row of shelves stands.
TEST(EvidenceByCause, AStraightRowOfObjectsDecidesOnlyWithOthers) {
  const HypothesisComparisonConfig config;
  EXPECT_LT(config.front_cap, ConvergenceConfig{}.log_ratio);
  for (int k = 0; k < 20; ++k) {
    const double turn = 0.3 * k;
    const Eigen::Vector2d along(std::cos(turn), std::sin(turn));
    const auto counts = [&](double bulge_m, double length_m) {
      EvidenceByCause evidence;
      for (int i = 0; i < 5; ++i)
        evidence.add({OutlierCause::Kind::unplanned, i, 0},
                     seen_along(0.2 * i * length_m * along, 0.2 * (i + 1) * length_m * along, bulge_m));
      return evidence.total(config);
    };
    EXPECT_EQ(counts(0.02, 4.0), config.front_cap);
    EXPECT_GT(counts(0.3, 4.0), 2.0 * ConvergenceConfig{}.log_ratio) << "it is not straight";
  }
  EvidenceByCause with_wall;
  with_wall.add({OutlierCause::Kind::unplanned, 0, 0}, seen_along({0.0, 0.0}, {4.0, 0.0}));
  with_wall.add({OutlierCause::Kind::not_built, 3}, 50.0);
  EXPECT_GT(with_wall.total(config), config.front_cap + config.cause_cap);
}

// A row of shelves is seen before the wall behind it, and its end before another one.
TEST(EvidenceByCause, AFrontWithItsEndIsStillAFront) {
  const HypothesisComparisonConfig config;
  EvidenceByCause evidence;
  evidence.add({OutlierCause::Kind::in_front_of_face, 1, 0}, seen_along({0.0, 0.0}, {6.0, 0.0}));
  evidence.add({OutlierCause::Kind::in_front_of_face, 2, 0}, seen_along({6.0, 0.0}, {6.0, 1.1}), 0.8);
  EXPECT_EQ(evidence.total(config), config.front_cap);
}

TEST(EvidenceByCause, AWallThatBeamsEndInIsNotMissing) {
  const HypothesisComparisonConfig config;
  EvidenceByCause niche;
  niche.add({OutlierCause::Kind::not_built, 3}, 50.0, 20.0);
  EXPECT_EQ(niche.total(config), config.cause_cap);
}

TEST(EvidenceByCause, AWallThatBeamsMeetIsNotMissing) {
  const HypothesisComparisonConfig config;
  const OutlierCause wall{OutlierCause::Kind::not_built, 3};
  const auto met = [&](double share) {
    EvidenceByCause evidence;
    evidence.add(wall, 50.0, 40.0);
    evidence.sums().at(wall).met = share * 40.0;
    return evidence.total(config);
  };
  EXPECT_EQ(met(config.met_share), config.missing_wall_cap);
  EXPECT_EQ(met(1.01 * config.met_share), config.cause_cap);
}

TEST(EvidenceByCause, AnObjectCountsOnceWhateverItStandsBefore) {
  const HypothesisComparisonConfig config = with_caps(4.0, 8.0);
  const auto box = [](double x0, double y0, double x1, double y1) {
    return Eigen::AlignedBox2d(Eigen::Vector2d(x0, y0), Eigen::Vector2d(x1, y1));
  };
  using Kind = OutlierCause::Kind;
  EvidenceByCause corner;
  corner.add({Kind::in_front_of_face, 1, 2}, seen_in(9.0, box(0.0, 0.4, 0.4, 0.4)));
  corner.add({Kind::in_front_of_face, 2, 4}, seen_in(9.0, box(0.4, 0.0, 0.4, 0.4)));
  EXPECT_EQ(corner.total(config), 4.0);
  corner.add({Kind::unplanned, 0, 0}, seen_in(9.0, box(0.5, 0.5, 0.55, 0.55)));
  EXPECT_EQ(corner.total(config), 4.0);
  corner.add({Kind::in_front_of_face, 3, 4}, seen_in(9.0, box(5.0, 0.0, 5.0, 0.4)));
  EXPECT_EQ(corner.total(config), 8.0) << "another one stands far from it";
  EvidenceByCause wall;
  for (int x = 0; x < 6; ++x) wall.add({Kind::unplanned, x, 0}, seen_in(9.0, box(x, 0.0, x + 1.0, 0.0)));
  EXPECT_NEAR(wall.total(config), 24.0, 1e-9) << "six metres are no single object";
  wall.add({Kind::not_built, 7}, seen_in(9.0, box(0.0, 0.0, 6.0, 0.0)));
  EXPECT_NEAR(wall.total(config), 32.0, 1e-9);
}

TEST(EvidenceByCause, AnObjectThatThePlanOutlinesCountsForMore) {
  const HypothesisComparisonConfig config;
  const OutlierCause cause{OutlierCause::Kind::in_front_of_face, 1, 2};
  const auto seen = [&](double length_m, double unexplained) {
    EvidenceByCause evidence;
    evidence.add(cause, seen_in(100.0, {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(length_m, 0.0)}));
    evidence.sums().at(cause).unexplained = unexplained;
    return evidence.total(config);
  };
  EXPECT_EQ(seen(0.5, 0.0), config.outlined_cap);
  EXPECT_EQ(seen(0.5, 100.0 * config.outline_share), config.outlined_cap);
  EXPECT_EQ(seen(0.5, 101.0 * config.outline_share), config.object_cap);
  EXPECT_EQ(seen(0.5, 50.0), config.object_cap);
  EXPECT_EQ(seen(0.5, 75.0), 0.5 * config.object_cap) << "most of it stands there at either pose";
  EXPECT_EQ(seen(0.5, 100.0), 0.0);
  EXPECT_EQ(seen(1.2 * config.object_m, 0.0), 1.2 * config.object_cap) << "a front as long as furniture's";
}

}  // namespace
}  // namespace plumbline::slam
