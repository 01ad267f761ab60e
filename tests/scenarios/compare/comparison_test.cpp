// SPDX-License-Identifier: Apache-2.0
#include "scenarios/compare/comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bim/errors.h"
#include "bim/random/stream.h"
#include "scenarios/compare/paired_tests.h"
#include "tests/scenarios/compare/sample_rows.h"

namespace plumbline::scenarios {
namespace {

using Rows = std::vector<SweepRow>;

Comparison compared(const Rows& a, const Rows& b) {
  return compare_rows(pair_rows(a, b), {compared_metrics().begin(), compared_metrics().end()});
}

const ComparedValue& value_of(const Comparison& comparison, const std::string& name, const std::string& scenario = "") {
  for (const ComparedMethod& method : comparison.methods)
    for (const ComparedValue& value : method.values)
      if (value.name == name && value.scenario == scenario) return value;
  throw InternalError("there is no " + name + " of '" + scenario + "'");
}

TEST(Comparison, EqualDigestsAreTheSame) {
  const Rows rows = slam_rows({0.01, 0.02, 0.03});
  const Comparison comparison = compared(rows, rows);
  EXPECT_EQ(comparison.finding, Finding::same);
  EXPECT_TRUE(comparison.methods.front().same);
  EXPECT_EQ(comparison.same_sensors, 3U);
}

// Eight pairs, B twice A: all ratios are 2, and of the 256 ways of signs two are as far from even.
TEST(Comparison, TwiceTheErrorIsWorse) {
  const Rows a = slam_rows({1, 2, 3, 4, 5, 6, 7, 8}), b = slam_rows({2, 4, 6, 8, 10, 12, 14, 16});
  const Comparison comparison = compared(a, b);
  const ComparedValue& ate = value_of(comparison, "ate_aligned_rmse_m");
  EXPECT_EQ(ate.pairs, 8U);
  EXPECT_EQ(ate.worse, 8U);
  EXPECT_NEAR(*ate.shift, 2.0, 1e-12);
  EXPECT_NEAR(*ate.geometric_mean, 2.0, 1e-12);
  EXPECT_NEAR(ate.interval->first, 2.0, 1e-12);
  EXPECT_NEAR(ate.interval->second, 2.0, 1e-12);
  EXPECT_NEAR(*ate.p, 2.0 / 256.0, 1e-12);
  EXPECT_EQ(ate.a, 4.5);
  EXPECT_EQ(ate.b, 9.0);
  EXPECT_EQ(ate.finding, Finding::worse);
  EXPECT_EQ(comparison.finding, Finding::worse);
  EXPECT_EQ(compared(b, a).finding, Finding::better);
}

// All changes of one size, so that the typical one is none: 21 walks got worse and 9 better.
TEST(Comparison, TheSideIsThatOfTheRanksWhereTheTypicalChangeIsNone) {
  std::vector<double> before(30, 1.0), after(30, 1.0);
  for (std::size_t i = 0; i < 30; ++i) (i < 21 ? after : before)[i] = 2.0;
  const Comparison comparison = compared(slam_rows(before), slam_rows(after));
  const ComparedValue& ate = value_of(comparison, "ate_aligned_rmse_m");
  EXPECT_EQ(ate.shift, 1.0);
  EXPECT_LT(*ate.p, 0.05);
  EXPECT_TRUE(ate.finding == Finding::worse || ate.finding == Finding::worse_alone);
  const Comparison other = compared(slam_rows(after), slam_rows(before));
  const ComparedValue& back = value_of(other, "ate_aligned_rmse_m");
  EXPECT_TRUE(back.finding == Finding::better || back.finding == Finding::better_alone);
}

TEST(Comparison, FewPairsShowNothing) {
  const Comparison comparison = compared(slam_rows({1, 2, 3, 4, 5}), slam_rows({2, 4, 6, 8, 10}));
  EXPECT_EQ(comparison.tests, 0U);
  EXPECT_EQ(comparison.finding, Finding::not_shown);
  EXPECT_NEAR(*value_of(comparison, "ate_aligned_rmse_m").p, 2.0 / 32.0, 1e-12);
}

TEST(Comparison, ASinglePairOnlyDiffers) {
  const Comparison comparison = compared(slam_rows({1}), slam_rows({3}));
  const ComparedValue& ate = value_of(comparison, "ate_aligned_rmse_m");
  EXPECT_EQ(comparison.finding, Finding::differs);
  EXPECT_EQ(ate.finding, Finding::differs);
  EXPECT_NEAR(*ate.shift, 3.0, 1e-12);
  EXPECT_FALSE(ate.p);
  EXPECT_FALSE(ate.interval);
}

// As of a run directory whose outside trajectory has no stages: equal scores are no proof that all is the same.
TEST(Comparison, EqualScoresWithoutDigestsAreNeitherTheSameNorOther) {
  Rows rows = slam_rows({1});
  rows.front().method_digest.clear();
  EXPECT_EQ(compared(rows, rows).finding, Finding::not_shown);
  Rows other = slam_rows({1});
  other.front().method_digest = "of another version";
  EXPECT_EQ(compared(slam_rows({1}), other).finding, Finding::differs);
  EXPECT_EQ(value_of(compared(slam_rows({1}), other), "ate_aligned_rmse_m").equal, 1U);
}

TEST(Comparison, WhatDidNotConvergeIsInfinitelyWorse) {
  Rows a, b;
  for (int seed = 1; seed <= 8; ++seed) {
    a.push_back(localization_row(seed, "success", 2.0));
    b.push_back(seed <= 7 ? localization_row(seed, "late", -1.0) : localization_row(seed, "success", 1.0));
  }
  const Comparison comparison = compared(a, b);
  const ComparedValue& converged = value_of(comparison, "localization.converged_at_m");
  EXPECT_EQ(converged.worse, 7U);
  EXPECT_EQ(converged.better, 1U);
  EXPECT_EQ(converged.missing_b, 7U);
  EXPECT_FALSE(converged.b);
  EXPECT_EQ(*converged.shift, INFINITY);
  EXPECT_NEAR(*converged.p, 4.0 / 256.0, 1e-12);  // the one that is better has the least rank
  EXPECT_EQ(converged.finding, Finding::worse);
  const ComparedValue& right = value_of(comparison, "right");
  EXPECT_EQ(right.worse, 7U);
  EXPECT_NEAR(*right.p, 2.0 / 128.0, 1e-12);
  EXPECT_EQ(*value_of(compared(b, a), "localization.converged_at_m").shift, 0.0);
}

TEST(Comparison, AnEarlyWrongAnswerDoesNotConvergeEarlier) {
  const Rows a = {localization_row(1, "success", 5.0), localization_row(2, "success", 5.0)};
  const Rows b = {localization_row(1, "false_convergence", 1.0), localization_row(2, "success", 5.5)};
  const Comparison comparison = compared(a, b);
  EXPECT_EQ(value_of(comparison, "localization.converged_at_m").worse, 2U);
  EXPECT_EQ(value_of(comparison, "wrong").worse, 1U);
  ASSERT_EQ(comparison.failures_b.size(), 1U);
  EXPECT_EQ(comparison.failures_b.front().run, "house, seed 1");
  EXPECT_TRUE(comparison.failures_a.empty());
  EXPECT_EQ(compared(b, a).failures_a.size(), 1U);
}

// Where no pose is identifiable, claiming none is right, and a claimed one is no better for having an error.
TEST(Comparison, HonestAmbiguityHasNoErrorToCompare) {
  Rows a = {localization_row(1, "honest_ambiguity", -1.0)}, b = {localization_row(1, "overconfident", 1.0)};
  value_in(b.front(), "localization.ape_rmse_m") = 0.1;
  const Comparison comparison = compared(a, b);
  EXPECT_EQ(value_of(comparison, "right").worse, 1U);
  EXPECT_THROW((void)value_of(comparison, "localization.ape_rmse_m"), InternalError);
}

TEST(Comparison, SharesAreSubtracted) {
  Rows a = slam_rows({1, 1}), b = slam_rows({1, 1});
  for (Rows* rows : {&a, &b})
    for (SweepRow& row : *rows) value_in(row, "rooms.recall") = rows == &a ? 0.0 : 0.5;
  b.front().method_digest = "other";
  const ComparedValue recall = value_of(compared(a, b), "rooms.recall");
  EXPECT_EQ(recall.better, 2U);
  EXPECT_EQ(*recall.shift, 0.5);
  EXPECT_FALSE(recall.geometric_mean);
}

TEST(Comparison, AFailedWalkIsNamedAndLeftOut) {
  const Rows a = slam_rows({1, 2, 3});
  Rows b = slam_rows({2, 3, 4});
  b[1].verdict = "failed";
  b[1].values.assign(b[1].values.size(), std::nullopt);
  const Comparison comparison = compared(a, b);
  EXPECT_EQ(comparison.methods.front().failed, 1U);
  EXPECT_EQ(value_of(comparison, "ate_aligned_rmse_m").pairs, 2U);
  ASSERT_EQ(comparison.failures_b.size(), 1U);
  EXPECT_EQ(comparison.failures_b.front().run, "house, seed 2");
}

TEST(Comparison, NamesWhatHasNoPartner) {
  Rows a = slam_rows({1, 2, 3}), b = slam_rows({1, 2});
  b.push_back(slam_row(9, 1.0));
  a.push_back(slam_row(1, 1.0));  // once more than in B
  const Comparison comparison = compared(a, b);
  EXPECT_EQ(comparison.pairs, 2U);
  EXPECT_EQ(comparison.only_a, (std::vector<std::string>{"house, seed 3, vgicp", "house, seed 1, vgicp"}));
  EXPECT_EQ(comparison.only_b, (std::vector<std::string>{"house, seed 9, vgicp"}));
}

TEST(Comparison, SaysWhetherPairsShareTheirSensorData) {
  const Rows a = slam_rows({1, 2, 3});
  Rows b = slam_rows({2, 3, 4});
  b[0].sensor_digest = "another walk";
  b[1].sensor_digest.clear();
  Comparison comparison = compared(a, b);
  EXPECT_EQ(comparison.same_sensors, 1U);
  EXPECT_EQ(comparison.other_sensors, 1U);
  EXPECT_EQ(comparison.unknown_sensors, 1U);
  EXPECT_FALSE(comparison.shared_walks);
  Rows variants = a;
  for (SweepRow& row : variants) row.variant = "compass";
  variants.insert(variants.end(), a.begin(), a.end());
  EXPECT_TRUE(compared(variants, variants).shared_walks);
}

TEST(Comparison, EqualDigestsWithOtherScoresAreNotTheSame) {
  const Rows a = slam_rows({1, 2});
  Rows b = a;
  value_in(b.front(), "ate_aligned_rmse_m") = 1.5;
  const Comparison comparison = compared(a, b);
  EXPECT_EQ(comparison.rescored, 1U);
  EXPECT_NE(comparison.finding, Finding::same);
}

TEST(Comparison, HasALineForEachOfSeveralScenarios) {
  Rows a = slam_rows({1, 2, 3}), b = slam_rows({2, 4, 6});
  for (const Rows& more : {slam_rows({1, 2, 3}, "office")}) {
    a.insert(a.end(), more.begin(), more.end());
    b.insert(b.end(), more.begin(), more.end());
  }
  const Comparison comparison = compared(a, b);
  EXPECT_EQ(value_of(comparison, "ate_aligned_rmse_m").pairs, 6U);
  EXPECT_EQ(value_of(comparison, "ate_aligned_rmse_m", "house").worse, 3U);
  EXPECT_EQ(value_of(comparison, "ate_aligned_rmse_m", "office").equal, 3U);
  EXPECT_EQ(value_of(comparison, "ate_aligned_rmse_m", "office").finding, Finding::same);
  EXPECT_FALSE(value_of(comparison, "ate_aligned_rmse_m", "house").finding);
}

/// Rows of two methods at random, one of them the other way round in the half of the trials.
Rows drawn(const Stream& stream, std::uint64_t trial, std::uint32_t side, double factor) {
  Rows rows;
  for (std::uint32_t seed = 0; seed < 6 + trial % 12; ++seed) {
    rows.push_back(slam_row(static_cast<int>(seed), factor * std::exp(stream.gauss(trial, seed, side))));
    const bool right = stream.uniform(trial, seed, 2 + side) < 0.7;
    rows.push_back(localization_row(static_cast<int>(seed), right ? "success" : "overconfident",
                                    stream.uniform(trial, seed, 4 + side)));
  }
  return rows;
}

Finding opposite(Finding finding) {
  switch (finding) {
    case Finding::better:
      return Finding::worse;
    case Finding::worse:
      return Finding::better;
    case Finding::better_alone:
      return Finding::worse_alone;
    case Finding::worse_alone:
      return Finding::better_alone;
    default:
      return finding;
  }
}

void expect_opposite(double one, double other) {
  if (std::isinf(one))
    EXPECT_EQ(one, -other);
  else
    EXPECT_NEAR(one, -other, 1e-12);
}

TEST(Comparison, TheOtherWayRoundTurnsRatiosAndFindings) {
  const Stream stream(11, "bim.generate");
  int shown = 0;
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    const Rows a = drawn(stream, trial, 0, 1.0), b = drawn(stream, trial, 1, trial % 2 == 0 ? 4.0 : 1.0);
    const Comparison there = compared(a, b), back = compared(b, a);
    EXPECT_EQ(back.finding, opposite(there.finding)) << trial;
    if (there.finding != Finding::not_shown) ++shown;
    EXPECT_EQ(there.tests, back.tests);
    EXPECT_EQ(there.failures_a.size(), back.failures_b.size());
    for (std::size_t m = 0; m < there.methods.size(); ++m)
      for (std::size_t i = 0; i < there.methods[m].values.size(); ++i) {
        const ComparedValue &one = there.methods[m].values[i], &other = back.methods[m].values[i];
        EXPECT_EQ(one.better, other.worse);
        EXPECT_EQ(one.worse, other.better);
        EXPECT_EQ(one.p, other.p);
        EXPECT_EQ(*one.finding, opposite(*other.finding));
        if (one.change != Change::ratio) continue;
        expect_opposite(std::log(*one.shift), std::log(*other.shift));
        if (one.interval) expect_opposite(std::log(one.interval->first), std::log(other.interval->second));
        if (one.geometric_mean) expect_opposite(std::log(*one.geometric_mean), std::log(*other.geometric_mean));
      }
  }
  EXPECT_GT(shown, 40);
  EXPECT_LT(shown, 160);
}

// Two ways of one method that differ by chance alone: at most 5 % of the comparisons may name a side.
TEST(Comparison, ErrsInFivePercentWhateverTheNumberOfTests) {
  const Stream stream(12, "bim.generate");
  int named = 0;
  constexpr int trials = 600;
  for (int trial = 0; trial < trials; ++trial) {
    const auto at = static_cast<std::uint64_t>(trial);
    if (compared(drawn(stream, at, 0, 1.0), drawn(stream, at, 1, 1.0)).finding != Finding::not_shown) ++named;
  }
  EXPECT_GT(named, 2);
  EXPECT_LT(named, 0.05 * trials + 3.0 * std::sqrt(0.05 * 0.95 * trials));
}

}  // namespace
}  // namespace plumbline::scenarios
