// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/localization_score.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "tests/scenarios/metrics/straight_walk.h"

namespace plumbline::scenarios::score {
namespace {

constexpr int scans = 200;  // 20 s at 0.5 m/s

Truth walk() { return straight_walk(scans, {0.0, 0.0, 0.5}, 0.05); }

/// Converged from scan `from` on, with poses off by `offset_m`.
std::vector<Belief> converges_at(int from, double offset_m) {
  const Truth truth = walk();
  std::vector<Belief> beliefs;
  for (int i = 0; i < scans; ++i) {
    Belief belief;
    belief.stamp = i * scan_ns;
    if (i >= from) {
      belief.state = slam::State::converged;
      belief.X_WR = Pose::from_xyz_yaw(Eigen::Vector3d(0.0, offset_m, 0.0), 0.0) * truth.at(belief.stamp);
      belief.hypotheses = {{1.0, *belief.X_WR, Eigen::Matrix3d::Zero(), ""}};
    }
    beliefs.push_back(belief);
  }
  return beliefs;
}

LocalizationScore judge(const std::vector<Belief>& beliefs, const std::optional<Identifiability>& known = {}) {
  return score_localization(walk(), beliefs, known);
}

TEST(Localization, SuccessWithItsNumbers) {
  const LocalizationScore score = judge(converges_at(40, 0.1));
  EXPECT_EQ(score.verdict, LocalizationVerdict::success);
  EXPECT_NEAR(*score.converged_at_s, 4.0, 1e-12);
  EXPECT_NEAR(*score.converged_at_m, 2.0, 1e-9);
  EXPECT_NEAR(*score.ape_rmse_m, 0.1, 1e-12);
  EXPECT_NEAR(*score.yaw_rmse_deg, 0.0, 1e-12);
  EXPECT_EQ(score.hypotheses, 1);
  EXPECT_FALSE(score.identifiable);
}

TEST(Localization, NeesLeavesOutWhatHasNoCovarianceAndSaysSo) {
  auto beliefs = converges_at(40, 0.2);
  for (std::size_t i = 40; i < beliefs.size(); ++i)
    beliefs[i].hypotheses[0].covariance = Eigen::Vector3d(0.01, 0.04, 0.01).asDiagonal();
  LocalizationScore score = judge(beliefs);
  EXPECT_NEAR(score.nees.value(), 1.0, 1e-9);  // 0.2 m off where the standard deviation is 0.2 m
  EXPECT_EQ(score.nees_left_out, 0.0);
  beliefs[50].hypotheses[0].covariance = Eigen::Vector3d(0.01, -0.04, 0.01).asDiagonal();
  beliefs[51].hypotheses[0].covariance.setConstant(std::numeric_limits<double>::quiet_NaN());
  score = judge(beliefs);
  EXPECT_NEAR(score.nees.value(), 1.0, 1e-9);
  EXPECT_EQ(score.nees_left_out, 2.0);
  score = judge(converges_at(40, 0.1));  // of zeros
  EXPECT_FALSE(score.nees);
  EXPECT_EQ(score.nees_left_out, static_cast<double>(scans - 40));
  EXPECT_FALSE(judge(converges_at(scans, 0.1)).nees_left_out);
}

TEST(Localization, WrongSingleAnswerIsFalseConvergence) {
  EXPECT_EQ(judge(converges_at(40, 0.51)).verdict, LocalizationVerdict::false_convergence);
  auto turned = converges_at(40, 0.0);
  for (Belief& belief : turned)
    if (belief.X_WR) belief.X_WR->q = exp_so3({0, 0, 11.0 * std::numbers::pi / 180.0}) * belief.X_WR->q;
  EXPECT_EQ(judge(turned).verdict, LocalizationVerdict::false_convergence);
}

TEST(Localization, NeverOrTooLateIsLate) {
  EXPECT_EQ(judge(converges_at(scans, 0.0)).verdict, LocalizationVerdict::late);
  EXPECT_FALSE(judge(converges_at(scans, 0.0)).ape_rmse_m);
  EXPECT_EQ(judge(converges_at(scans - 40, 0.0)).verdict, LocalizationVerdict::late);  // held for 3.9 s only
}

TEST(Localization, ErrorsWhileLostCount) {
  auto beliefs = converges_at(0, 0.0);
  for (int i = 100; i < scans; ++i) {
    beliefs[static_cast<std::size_t>(i)].state = slam::State::lost;
    beliefs[static_cast<std::size_t>(i)].X_WR.reset();  // held against its last answer, which the robot walks away from
  }
  const LocalizationScore score = judge(beliefs);
  EXPECT_EQ(score.verdict, LocalizationVerdict::lost);
  EXPECT_GT(*score.ape_rmse_m, 1.0);
}

// Carried on by odometry the pose stays right, but it was given up.
TEST(Localization, AnAnswerThatIsGivenUpForGoodIsLostHoweverRightItsPose) {
  for (const slam::State state : {slam::State::lost, slam::State::searching, slam::State::ambiguous}) {
    auto beliefs = converges_at(0, 0.0);
    for (std::size_t i = 100; i < beliefs.size(); ++i) beliefs[i].state = state;
    EXPECT_EQ(judge(beliefs).verdict, LocalizationVerdict::lost);
    beliefs.back().state = slam::State::converged;
    EXPECT_EQ(judge(beliefs).verdict, LocalizationVerdict::success);
  }
}

TEST(Localization, WrongAgainAfterConvergenceIsNoSuccess) {
  auto beliefs = converges_at(0, 0.0);
  beliefs[150].X_WR->t.y() += 3.0;
  EXPECT_EQ(judge(beliefs).verdict, LocalizationVerdict::false_convergence);
}

TEST(Localization, WhereThePlanHasTwoAnswers) {
  Identifiability alias;
  alias.others_W = {Pose::from_xyz_yaw({50.0, 0.0, 0.5}, std::numbers::pi)};
  EXPECT_EQ(judge(converges_at(40, 0.0), alias).verdict, LocalizationVerdict::lucky);
  EXPECT_EQ(judge(converges_at(40, 3.0), alias).verdict, LocalizationVerdict::overconfident);

  auto both = converges_at(scans, 0.0);
  const Pose X_WR = walk().at(both.back().stamp);
  const auto answer = [&](double true_mass, std::size_t copies) {
    both.back().hypotheses.assign(copies, {true_mass, X_WR, Eigen::Matrix3d::Zero(), ""});
    both.back().hypotheses.push_back({1.0 - true_mass, alias.others_W[0], Eigen::Matrix3d::Zero(), ""});
    return judge(both, alias).verdict;
  };
  EXPECT_EQ(answer(0.5, 1), LocalizationVerdict::honest_ambiguity);
  EXPECT_EQ(answer(0.25, 1), LocalizationVerdict::honest_ambiguity);  // the least share: 0.5 / 2
  EXPECT_EQ(answer(0.2, 1), LocalizationVerdict::late);
  EXPECT_EQ(answer(0.3, 3), LocalizationVerdict::late);  // more than 2 |A| + 1 hypotheses
  both.back().hypotheses = {{0.6, X_WR, Eigen::Matrix3d::Zero(), ""},
                            {0.4, Pose::from_xyz_yaw({20, 9, 0.5}, 0.0), Eigen::Matrix3d::Zero(), ""}};
  EXPECT_EQ(judge(both, alias).verdict, LocalizationVerdict::late);  // one that is no alias
  both.back().hypotheses[0].mass = 0.5;
  both.back().hypotheses[1].mass = 0.01;
  both.back().hypotheses.push_back({0.49, alias.others_W[0], Eigen::Matrix3d::Zero(), ""});
  EXPECT_EQ(judge(both, alias).verdict, LocalizationVerdict::honest_ambiguity);  // it is listed, not claimed
}

TEST(Localization, FurnitureIsNotedAndMakesNoAnswerRight) {
  Identifiability known;  // ambiguous by the building alone
  known.others_W = {Pose::from_xyz_yaw({50.0, 0.0, 0.5}, std::numbers::pi)};
  known.with_furniture = IdentifiabilityAnswer{true, 0.0, 0.0, 0.0, {}, {}, {}, {}};
  const LocalizationScore told = judge(converges_at(40, 0.0), known);
  EXPECT_EQ(told.verdict, LocalizationVerdict::lucky);
  EXPECT_EQ(told.evidence, Evidence::ambiguous);
  ASSERT_TRUE(told.with_furniture.has_value());
  EXPECT_EQ(told.with_furniture->evidence, Evidence::unique);
  EXPECT_EQ(told.with_furniture->aliases, 0);
  EXPECT_TRUE(told.evidence_by_furniture);
  EXPECT_EQ(judge(converges_at(40, 3.0), known).verdict, LocalizationVerdict::overconfident);
  known.with_furniture.reset();  // methods were not told of it
  EXPECT_EQ(judge(converges_at(40, 0.0), known).verdict, LocalizationVerdict::lucky);
  EXPECT_FALSE(judge(converges_at(40, 0.0), known).evidence_by_furniture);
}

TEST(Localization, SureAndWrongAreTheTwoVerdictsOfAWrongSingleAnswer) {
  using V = LocalizationVerdict;
  for (const V verdict : {V::false_convergence, V::overconfident}) EXPECT_TRUE(is_sure_and_wrong(verdict));
  for (const V verdict : {V::success, V::honest_ambiguity, V::late, V::lost, V::lucky})
    EXPECT_FALSE(is_sure_and_wrong(verdict));
}

TEST(Localization, AWrongAnswerThatStoodIsNotMadeGoodByDoubtAtTheEnd) {
  Identifiability alias;
  alias.others_W = {Pose::from_xyz_yaw({50.0, 0.0, 0.5}, std::numbers::pi)};
  for (const double offset_m : {0.0, 3.0}) {
    auto beliefs = converges_at(40, offset_m);
    for (std::size_t i = 190; i < beliefs.size(); ++i) {
      beliefs[i].state = slam::State::ambiguous;
      beliefs[i].hypotheses = {{0.5, walk().at(beliefs[i].stamp), Eigen::Matrix3d::Zero(), ""},
                               {0.5, alias.others_W[0], Eigen::Matrix3d::Zero(), ""}};
    }
    EXPECT_EQ(judge(beliefs, alias).verdict,
              offset_m > 0.0 ? LocalizationVerdict::overconfident : LocalizationVerdict::honest_ambiguity);
  }
}

TEST(Localization, ARightAnswerBeforeAnythingCouldTellIsLuck) {
  Identifiability known;
  known.identifiable = true;
  known.at_s = 8.0;
  known.marginal_from_s = 6.0;
  EXPECT_EQ(judge(converges_at(40, 0.0), known).verdict, LocalizationVerdict::lucky);    // at 4 s
  EXPECT_EQ(judge(converges_at(60, 0.0), known).verdict, LocalizationVerdict::success);  // at 6 s, on marginal evidence
  EXPECT_EQ(judge(converges_at(40, 3.0), known).verdict, LocalizationVerdict::false_convergence);
}

TEST(Localization, OnWeakEvidenceARightAnswerAndAnHonestAmbiguityAreBothRight) {
  Identifiability known;
  known.others_W = {Pose::from_xyz_yaw({20, 9, 0.5}, 0.0)};
  known.marginal_from_s = 3.0;
  const LocalizationScore answered = judge(converges_at(40, 0.0), known);
  EXPECT_EQ(answered.evidence, Evidence::marginal);
  EXPECT_EQ(answered.verdict, LocalizationVerdict::success);
  EXPECT_EQ(judge(converges_at(20, 0.0), known).verdict, LocalizationVerdict::lucky);  // at 2 s nothing told
  EXPECT_EQ(judge(converges_at(40, 3.0), known).verdict, LocalizationVerdict::false_convergence);

  auto withdrawn = converges_at(40, 0.0);
  for (std::size_t i = 100; i < withdrawn.size(); ++i) withdrawn[i].state = slam::State::lost;
  EXPECT_NE(judge(withdrawn, known).verdict, LocalizationVerdict::success);
  auto open = converges_at(scans, 0.0);
  open.back().hypotheses = {{0.5, walk().at(open.back().stamp), Eigen::Matrix3d::Zero(), ""},
                            {0.5, known.others_W[0], Eigen::Matrix3d::Zero(), ""}};
  EXPECT_EQ(judge(open, known).verdict, LocalizationVerdict::honest_ambiguity);

  known.marginal_from_s.reset();
  EXPECT_EQ(judge(converges_at(40, 0.0), known).evidence, Evidence::ambiguous);
  EXPECT_EQ(judge(converges_at(40, 0.0), known).verdict, LocalizationVerdict::lucky);
}

TEST(Localization, WhatCanBeToldTooLateToHoldAnAnswerIsWeak) {
  const Truth truth = walk();
  const double end_s = slam::seconds(truth.scans.back() - truth.scans.front()), end_m = truth.walked().back();
  Identifiability known;
  known.identifiable = true;
  const auto evidence = [&](double at_s, double at_m) {
    known.at_s = at_s;
    known.at_m = at_m;
    return judge(converges_at(40, 0.0), known).evidence;
  };
  EXPECT_EQ(evidence(end_s - 5.1, end_m - 1.1), Evidence::unique);
  EXPECT_EQ(evidence(end_s - 4.9, end_m - 1.1), Evidence::marginal);
  EXPECT_EQ(evidence(end_s - 5.1, end_m - 0.9), Evidence::marginal);
}

/// 100 scans, then 3 s in the air and 100 more from 8 m aside.
Truth kidnapped_walk() {
  Truth truth;
  for (int i = 0; i < scans; ++i) {
    const bool after = i >= scans / 2;
    const slam::Nanoseconds stamp = i * scan_ns + (after ? 3'000'000'000 : 0);
    if (i == scans / 2) truth.set_down = stamp;
    truth.scans.push_back(stamp);
    truth.poses_W.push_back({stamp, Pose::from_xyz_yaw({0.05 * i, after ? 8.0 : 0.0, 0.5}, 0.0)});
  }
  return truth;
}

/// Right from scan 20 on; as if nothing had happened for `blind` scans after it was set down, lost for `lost` more,
/// then right.
std::vector<Belief> kidnapped_beliefs(int blind, int lost) {
  const Truth truth = kidnapped_walk();
  std::vector<Belief> beliefs;
  for (int i = 0; i < scans; ++i) {
    const int since = i - scans / 2;
    Belief belief;
    belief.stamp = truth.scans[static_cast<std::size_t>(i)];
    belief.state = i < 20 ? slam::State::searching : slam::State::converged;
    if (since >= blind && since < blind + lost) belief.state = slam::State::lost;
    if (i >= 20) belief.X_WR = truth.at(belief.stamp);
    if (since >= 0 && since < blind + lost) belief.X_WR->t.y() = 0.0;
    beliefs.push_back(belief);
  }
  return beliefs;
}

TEST(Localization, AKidnappedRobotIsJudgedBeforeAndTimedAfter) {
  const Truth truth = kidnapped_walk();
  EXPECT_NEAR(truth.walked().back(), 0.05 * (scans - 2), 1e-9);
  EXPECT_EQ(truth.before().scans.size(), 100U);
  const LocalizationScore found = score_localization(truth, kidnapped_beliefs(21, 10), {});
  EXPECT_EQ(found.verdict, LocalizationVerdict::success);
  EXPECT_NEAR(*found.ape_rmse_m, 0.0, 1e-9);
  EXPECT_NEAR(*found.kidnap_wrong_s, 2.0, 1e-9);
  EXPECT_NEAR(*found.kidnap_found_s, 3.1, 1e-9);
  EXPECT_NEAR(*found.kidnap_found_m, 3.1 * 0.5, 1e-9);
  EXPECT_EQ(found.state, slam::State::converged);

  const LocalizationScore never = score_localization(truth, kidnapped_beliefs(100, 0), {});
  EXPECT_NEAR(*never.kidnap_wrong_s, 9.9, 1e-9);
  EXPECT_FALSE(never.kidnap_found_s);
  const LocalizationScore says_lost = score_localization(truth, kidnapped_beliefs(0, 100), {});
  EXPECT_EQ(*says_lost.kidnap_wrong_s, 0.0);
  EXPECT_FALSE(says_lost.kidnap_found_s);
  EXPECT_EQ(says_lost.state, slam::State::lost);
  // Too late to be held for 5 s.
  EXPECT_FALSE(score_localization(truth, kidnapped_beliefs(60, 0), {}).kidnap_found_s);
  EXPECT_FALSE(judge(converges_at(40, 0.1)).kidnap_wrong_s);
}

}  // namespace
}  // namespace plumbline::scenarios::score
