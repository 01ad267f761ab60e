// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/failure_cause.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/scenarios/metrics/straight_walk.h"

namespace plumbline::scenarios::score {
namespace {

constexpr int scans = 100;

Truth walk() { return straight_walk(scans, {0.0, 1.0, 0.5}, 0.1); }

/// A half turn about (5, 3).
Pose half_turn() { return Pose::from_xyz_yaw({10.0, 6.0, 0.0}, std::numbers::pi); }

/// Holds the places that are the true pose moved by each of `where`.
Belief holding(int i, const std::vector<Pose>& where, slam::State state) {
  Belief belief;
  belief.stamp = i * scan_ns;
  belief.state = state;
  const Pose X_WR = walk().at(belief.stamp);
  for (const Pose& g : where)
    belief.hypotheses.push_back({1.0 / static_cast<double>(where.size()), g * X_WR, Eigen::Matrix3d::Identity(), ""});
  if (state == slam::State::converged) belief.X_WR = where.front() * X_WR;
  return belief;
}

std::optional<FailureAt> why(const std::vector<Belief>& beliefs,
                             LocalizationVerdict verdict = LocalizationVerdict::false_convergence) {
  return failure_of(walk(), beliefs, verdict, {half_turn()}, {});
}

/// `first` up to scan `at`, `then` from there on.
std::vector<Belief> course(const std::vector<Pose>& first, int at, const std::vector<Pose>& then, slam::State state) {
  std::vector<Belief> beliefs;
  for (int i = 0; i < scans; ++i)
    beliefs.push_back(i < at ? holding(i, first, slam::State::ambiguous) : holding(i, then, state));
  return beliefs;
}

const Pose here;
const Pose elsewhere = Pose::from_xyz_yaw({0.0, 2.0, 0.0}, 0.0);

TEST(Failure, NoneWhereNothingFailed) {
  const auto beliefs = course({here}, 10, {here}, slam::State::converged);
  for (const auto verdict :
       {LocalizationVerdict::success, LocalizationVerdict::honest_ambiguity, LocalizationVerdict::lucky})
    EXPECT_FALSE(why(beliefs, verdict).has_value());
}

TEST(Failure, TheTwinWasPreferredWhileTheTruthWasStillThere) {
  const auto found = why(course({here, half_turn()}, 40, {half_turn(), here}, slam::State::converged));
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->failure, Failure::alias_preferred);
  EXPECT_EQ(found->stamp, 40 * scan_ns);
}

TEST(Failure, APlaceThatLooksDifferentWasPreferred) {
  const auto found = why(course({here, elsewhere}, 40, {elsewhere, here}, slam::State::converged));
  EXPECT_EQ(found->failure, Failure::wrong_model);
}

TEST(Failure, TheTruthWentBeforeTheAnswer) {
  auto beliefs = course({here, half_turn()}, 40, {half_turn()}, slam::State::converged);
  for (int i = 25; i < 40; ++i)
    beliefs[static_cast<std::size_t>(i)] = holding(i, {half_turn(), elsewhere}, slam::State::ambiguous);
  const auto found = why(beliefs);
  EXPECT_EQ(found->failure, Failure::depleted);
  EXPECT_EQ(found->stamp, 25 * scan_ns);
}

TEST(Failure, TheTruthWasNeverThere) {
  const auto found = why(course({half_turn(), elsewhere}, 40, {elsewhere}, slam::State::converged));
  EXPECT_EQ(found->failure, Failure::never_sampled);
  EXPECT_EQ(found->stamp, 0);
}

TEST(Failure, AParticleKeepsTheTruth) {
  auto beliefs = course({elsewhere}, 40, {elsewhere}, slam::State::converged);
  const Pose X_WR = walk().at(40 * scan_ns);
  for (auto& belief : beliefs) belief.hypotheses.clear();
  beliefs[40].particles = {{X_WR.t.x() + 0.3, X_WR.t.y(), 0.2, 1.0}};
  EXPECT_EQ(why(beliefs)->failure, Failure::wrong_model);
  beliefs[40].particles[0].x += 0.3;
  EXPECT_EQ(why(beliefs)->failure, Failure::never_sampled);
}

TEST(Failure, TheRightAnswerWasLost) {
  const auto found = why(course({here}, 40, {here}, slam::State::converged));
  EXPECT_EQ(found->failure, Failure::undecided);  // right to the end: only too late
  auto beliefs = course({here}, 20, {here}, slam::State::converged);
  for (int i = 60; i < scans; ++i)
    beliefs[static_cast<std::size_t>(i)] = holding(i, {elsewhere}, slam::State::converged);
  const auto lost = why(beliefs, LocalizationVerdict::lost);
  EXPECT_EQ(lost->failure, Failure::tracking_lost);
  EXPECT_EQ(lost->stamp, 60 * scan_ns);
}

TEST(Failure, UndecidedToTheEnd) {
  const auto found = why(course({here, half_turn()}, scans, {}, slam::State::ambiguous), LocalizationVerdict::late);
  EXPECT_EQ(found->failure, Failure::undecided);
  EXPECT_EQ(found->stamp, (scans - 1) * scan_ns);
}

TEST(TwinError, IsSmallOnTheWrongTwinAndNotElsewhere) {
  Identifiability known;
  known.aliases_at_start = {half_turn()};
  const auto alias = score_localization(walk(), course({here}, 0, {half_turn()}, slam::State::converged), known);
  EXPECT_GT(*alias.ape_rmse_m, 2.0);
  EXPECT_LT(*alias.aliased_error_rmse_m, 1e-9);
  EXPECT_EQ(alias.true_mass, 0.0);
  const auto wrong = score_localization(walk(), course({here}, 0, {elsewhere}, slam::State::converged), known);
  EXPECT_GT(*wrong.aliased_error_rmse_m, 0.5);
}

TEST(Nees, IsTheNormalisedErrorSquared) {
  const Pose off = Pose::from_xyz_yaw({0.0, 0.2, 0.0}, 0.0);
  const auto score = score_localization(walk(), course({off}, 0, {off}, slam::State::converged), std::nullopt);
  EXPECT_NEAR(*score.nees, 0.04, 1e-9);  // P is the identity
  EXPECT_EQ(score.true_mass, 1.0);
}

}  // namespace
}  // namespace plumbline::scenarios::score
