// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/tracks.h"

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

/// A twin of every pose, turned half a turn: it walks the other way.
const Pose twin = Pose::from_xyz_yaw({20.0, 4.0, 0.0}, std::numbers::pi);

TEST(Tracks, FollowEachPlaceAlongTheWalk) {
  const score::Truth truth = walk(100);
  std::vector<BeliefRecord> beliefs;
  for (int i = 0; i < 100; ++i) {
    BeliefRecord belief;
    belief.stamp = i * scan_ns;
    const Pose X_WR = truth.at(belief.stamp);
    const double mass = 0.5 + 0.004 * i;
    const slam::Hypothesis here{mass, X_WR, Eigen::Matrix3d::Zero(), "kitchen"};
    const slam::Hypothesis there{1.0 - mass, twin * X_WR, Eigen::Matrix3d::Zero(), "hall"};
    // Whichever comes first, as methods list them by mass; the twin is not seen for a while.
    belief.hypotheses = i % 2 == 0 ? std::vector{here, there} : std::vector{there, here};
    if (i > 40 && i < 60) belief.hypotheses = {here};
    beliefs.push_back(belief);
  }
  const std::vector<ReportTrack> tracks = hypothesis_tracks(beliefs, truth, 6);
  ASSERT_EQ(tracks.size(), 2U);
  EXPECT_TRUE(tracks[0].is_true);
  EXPECT_FALSE(tracks[1].is_true);
  EXPECT_EQ(tracks[1].room, "hall");
  ASSERT_EQ(tracks[0].points.size(), 100U);  // the mass changes with every scan
  EXPECT_EQ(tracks[0].points[30], Eigen::Vector2d(3.0, 0.62));
  EXPECT_EQ(tracks[1].points.size(), 81U);
}

TEST(Tracks, KeepTheTruePlaceAndThoseThatWereBelievedMost) {
  const score::Truth truth = walk(10);
  std::vector<BeliefRecord> beliefs;
  for (int i = 0; i < 10; ++i) {
    BeliefRecord belief;
    belief.stamp = i * scan_ns;
    const Pose X_WR = truth.at(belief.stamp);
    for (const double mass : {0.4, 0.3, 0.2})
      belief.hypotheses.push_back(
          {mass, Pose::from_xyz_yaw({0, 10.0 * mass, 0}, 0.0) * X_WR, Eigen::Matrix3d::Zero(), ""});
    belief.hypotheses.push_back({0.1, X_WR, Eigen::Matrix3d::Zero(), ""});
    beliefs.push_back(belief);
  }
  const std::vector<ReportTrack> tracks = hypothesis_tracks(beliefs, truth, 2);
  ASSERT_EQ(tracks.size(), 2U);
  EXPECT_TRUE(tracks[0].is_true);
  EXPECT_EQ(tracks[1].points.front().y(), 0.4);
}

TEST(Tracks, ALevelLineNeedsFewPointsAndLeavesNoGap) {
  const score::Truth truth = walk(100);
  std::vector<BeliefRecord> beliefs;
  for (int i = 0; i < 100; ++i)
    beliefs.push_back(
        {i * scan_ns, slam::State::converged, {{1.0, truth.at(i * scan_ns), Eigen::Matrix3d::Zero(), ""}}, {}});
  const std::vector<Eigen::Vector2d> points = hypothesis_tracks(beliefs, truth, 1).front().points;
  EXPECT_LT(points.size(), 30U);
  EXPECT_EQ(points.back().x(), 9.9);
  for (std::size_t i = 1; i < points.size(); ++i) EXPECT_LT(points[i].x() - points[i - 1].x(), 1.0);
}

}  // namespace
}  // namespace plumbline::scenarios
