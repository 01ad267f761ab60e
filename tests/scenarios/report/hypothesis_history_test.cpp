// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/hypothesis_history.h"

#include <gtest/gtest.h>

#include <numbers>

namespace plumbline::scenarios {
namespace {

constexpr slam::Nanoseconds scan_ns = 100'000'000;

/// A walk along x at 0.5 m/s.
score::Truth walk(int scans) {
  score::Truth truth;
  for (int i = 0; i < scans; ++i) {
    truth.scans.push_back(i * scan_ns);
    truth.poses_W.push_back({i * scan_ns, Pose::from_xyz_yaw({0.05 * i, 0.0, 0.5}, 0.0)});
  }
  return truth;
}

/// What was believed at each scan of a walk: hypotheses(i, X_WR), without what does not matter to histories.
template <class Hypotheses>
std::vector<BeliefRecord> believed(const score::Truth& truth, const Hypotheses& hypotheses) {
  std::vector<BeliefRecord> beliefs;
  for (std::size_t i = 0; i < truth.scans.size(); ++i) {
    BeliefRecord belief;
    belief.stamp = truth.scans[i];
    belief.hypotheses = hypotheses(i, truth.at(belief.stamp));
    beliefs.push_back(belief);
  }
  return beliefs;
}

slam::Hypothesis hypothesis(double mass, const Pose& X_WR, const std::string& room = "") {
  return {mass, X_WR, Eigen::Matrix3d::Zero(), room};
}

/// An alias of every pose, turned half a turn: it walks the other way.
const Pose alias = Pose::from_xyz_yaw({20.0, 4.0, 0.0}, std::numbers::pi);

TEST(Tracks, FollowEachPlaceAlongTheWalk) {
  const score::Truth truth = walk(100);
  const std::vector<BeliefRecord> beliefs = believed(truth, [](std::size_t i, const Pose& X_WR) {
    const double mass = 0.5 + 0.004 * static_cast<double>(i);
    const slam::Hypothesis here = hypothesis(mass, X_WR, "kitchen");
    const slam::Hypothesis there = hypothesis(1.0 - mass, alias * X_WR, "hall");
    if (i > 40 && i < 60) return std::vector{here};  // the alias is not seen for a while
    // Whichever comes first, as methods list them by mass.
    return i % 2 == 0 ? std::vector{here, there} : std::vector{there, here};
  });
  const std::vector<HypothesisHistory> histories = hypothesis_histories(beliefs, truth, 6).shown;
  ASSERT_EQ(histories.size(), 2U);
  EXPECT_TRUE(histories[0].is_true);
  EXPECT_FALSE(histories[1].is_true);
  EXPECT_EQ(histories[1].room, "hall");
  ASSERT_EQ(histories[0].points.size(), 100U);  // the mass changes with every scan
  EXPECT_EQ(histories[0].points[30], Eigen::Vector2d(3.0, 0.62));
  EXPECT_EQ(histories[1].points.size(), 81U);
}

TEST(Tracks, KeepTheTruePlaceAndThoseThatWereBelievedMost) {
  const score::Truth truth = walk(10);
  const std::vector<BeliefRecord> beliefs = believed(truth, [](std::size_t, const Pose& X_WR) {
    std::vector<slam::Hypothesis> hypotheses;
    for (const double mass : {0.4, 0.3, 0.2})
      hypotheses.push_back(hypothesis(mass, Pose::from_xyz_yaw({0, 10.0 * mass, 0}, 0.0) * X_WR));
    hypotheses.push_back(hypothesis(0.1, X_WR));
    return hypotheses;
  });
  const std::vector<HypothesisHistory> histories = hypothesis_histories(beliefs, truth, 2).shown;
  ASSERT_EQ(histories.size(), 2U);
  EXPECT_TRUE(histories[0].is_true);
  EXPECT_EQ(histories[1].points.front().y(), 0.4);
}

TEST(Tracks, KeepWhatIsBelievedLongAndSumUpTheRest) {
  // At each scan another hypothesis has 60 % for once; one keeps 30 % to the end.
  const score::Truth truth = walk(20);
  const std::vector<BeliefRecord> beliefs = believed(truth, [](std::size_t i, const Pose& X_WR) {
    const double y = 10.0 + 2.0 * static_cast<double>(i);
    return std::vector{hypothesis(0.6, Pose::from_xyz_yaw({0, y, 0}, 0.0) * X_WR),
                       hypothesis(0.3, Pose::from_xyz_yaw({0, 5.0, 0}, 0.0) * X_WR, "hall")};
  });
  const HypothesisHistories histories = hypothesis_histories(beliefs, truth, 2);
  ASSERT_EQ(histories.shown.size(), 2U);
  EXPECT_EQ(histories.shown[0].room, "hall");
  EXPECT_EQ(histories.left_out, 19U);
  ASSERT_EQ(histories.others.size(), 19U);  // the first that has 60 % is shown
  for (const Eigen::Vector2d& p : histories.others) EXPECT_DOUBLE_EQ(p.y(), 0.6);
}

TEST(Tracks, TurnTrueAndFalseWithTheHypothesis) {
  // It drifts off to the side in the second half, as on a stair that it does not see.
  const score::Truth truth = walk(100);
  const std::vector<BeliefRecord> beliefs = believed(truth, [](std::size_t i, const Pose& X_WR) {
    const double off = i < 50 ? 0.0 : 0.05 * static_cast<double>(i - 50);
    return std::vector{hypothesis(1.0, Pose::from_xyz_yaw({0.0, off, 0.0}, 0.0) * X_WR, "hall")};
  });
  const std::vector<HypothesisHistory> histories = hypothesis_histories(beliefs, truth, 6).shown;
  ASSERT_EQ(histories.size(), 2U);
  EXPECT_TRUE(histories[0].is_true);
  EXPECT_FALSE(histories[1].is_true);
  EXPECT_EQ(histories[0].hypothesis, histories[1].hypothesis);
  EXPECT_EQ(histories[0].points.back(), histories[1].points.front());  // one line in two colours
  EXPECT_NEAR(histories[1].points.front().x(), 6.0, 0.11);             // 0.5 m off
  EXPECT_EQ(histories[1].room, "hall");
}

TEST(Tracks, OfVeryManyTheHeaviestAreFollowed) {
  const score::Truth truth = walk(3);
  constexpr int many = 20'000;
  const std::vector<BeliefRecord> beliefs = believed(truth, [](std::size_t, const Pose& X_WR) {
    std::vector<slam::Hypothesis> all;
    for (int k = 0; k < many; ++k)
      all.push_back(hypothesis(k == many - 1 ? 0.5 : 0.5 / (many - 1),
                               Pose::from_xyz_yaw({k == many - 1 ? 0.0 : 10.0 + k, 0.0, 0.0}, 0.0) * X_WR));
    return all;
  });
  const HypothesisHistories histories = hypothesis_histories(beliefs, truth, 6);
  EXPECT_EQ(histories.left_out, static_cast<std::size_t>(many - 6));
  ASSERT_EQ(histories.shown.size(), 6U);
  EXPECT_TRUE(histories.shown[0].is_true);
  EXPECT_EQ(histories.shown[0].points.front().y(), 0.5);
  ASSERT_EQ(histories.others.size(), 3U);
  for (const Eigen::Vector2d& p : histories.others) EXPECT_NEAR(p.y(), 0.5, 0.001);
}

TEST(Tracks, ALevelLineNeedsFewPointsAndLeavesNoGap) {
  const score::Truth truth = walk(100);
  std::vector<BeliefRecord> beliefs;
  for (int i = 0; i < 100; ++i)
    beliefs.push_back(
        {i * scan_ns, slam::State::converged, {{1.0, truth.at(i * scan_ns), Eigen::Matrix3d::Zero(), ""}}, {}});
  const std::vector<Eigen::Vector2d> points = hypothesis_histories(beliefs, truth, 1).shown.front().points;
  EXPECT_LT(points.size(), 30U);
  EXPECT_EQ(points.back().x(), 9.9);
  for (std::size_t i = 1; i < points.size(); ++i) EXPECT_LT(points[i].x() - points[i - 1].x(), 1.0);
}

}  // namespace
}  // namespace plumbline::scenarios
