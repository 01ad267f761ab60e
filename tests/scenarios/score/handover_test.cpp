// SPDX-License-Identifier: Apache-2.0
#include "scenarios/score/handover.h"

#include <gtest/gtest.h>

#include "scenarios/metrics/metrics.h"

namespace plumbline::scenarios::score {
namespace {

bim::PlanFace face_of(int id, const std::string& wall, const Eigen::Vector2d& p0, const Eigen::Vector2d& p1) {
  bim::PlanFace face;
  face.id = id;
  face.wall_id = wall;
  face.p0 = p0;
  face.p1 = p1;
  const Eigen::Vector2d e = (p1 - p0).normalized();
  face.plane_W = {{-e.y(), e.x(), 0.0}, -Eigen::Vector2d(-e.y(), e.x()).dot(p0)};
  return face;
}

/// A room of 4 x 3 m whose south wall stands in two pieces, and a wall of the next room in line with them.
bim::Plan room() {
  bim::Plan plan;
  plan.faces = {face_of(10, "south_a", {0, 0}, {2, 0}), face_of(11, "south_b", {2, 0}, {4, 0}),
                face_of(12, "east", {4, 0}, {4, 3}),    face_of(13, "north", {4, 3}, {0, 3}),
                face_of(14, "west", {0, 3}, {0, 0}),    face_of(15, "next", {5, 0}, {9, 0})};
  return plan;
}

const Pose X_WR = Pose::from_xyz_yaw({1.0, 1.0, 0.4}, 0.5);

/// What the robot sees of a stretch of the plane.
slam::WallMatch seen(const Eigen::Vector2d& p0_W, const Eigen::Vector2d& p1_W, const std::vector<int>& faces) {
  const Pose X_RW = X_WR.inverse();
  return {faces, X_RW * Eigen::Vector3d(p0_W.x(), p0_W.y(), 1.0), X_RW * Eigen::Vector3d(p1_W.x(), p1_W.y(), 1.0)};
}

bool is_right(const slam::WallMatch& match, const bim::Plan& as_built) {
  return right_matches({match}, X_WR, room(), as_built).front();
}

TEST(Handover, AMatchIsRightWhereThePatchLiesOnThatWall) {
  EXPECT_TRUE(is_right(seen({0.5, 0.03}, {1.8, 0.03}, {10}), room()));
  EXPECT_FALSE(is_right(seen({0.5, 0.12}, {1.8, 0.12}, {10}), room()));  // 2 cm beyond the rule
  EXPECT_FALSE(is_right(seen({0.5, 0.0}, {1.8, 0.0}, {13}), room()));    // the opposite wall
  EXPECT_FALSE(is_right(seen({0.5, 0.0}, {1.8, 0.0}, {15}), room()));    // in line with it, in the next room
  EXPECT_FALSE(is_right(seen({1.8, 0.0}, {0.5, 0.0}, {10}), room()));    // its other side
  EXPECT_FALSE(is_right(seen({0.5, 0.0}, {1.8, 0.1}, {10}), room()));    // 4.4 degrees off
}

TEST(Handover, PiecesOfOneWallCountTogether) {
  EXPECT_TRUE(is_right(seen({0.8, 0.0}, {3.2, 0.0}, {10, 11}), room()));
  EXPECT_FALSE(is_right(seen({0.8, 0.0}, {3.9, 0.0}, {10}), room()));  // 1.2 of 3.1 m
  EXPECT_TRUE(is_right(seen({0.8, 0.0}, {3.9, 0.0}, {11}), room()));   // 1.9 of 3.1 m
}

TEST(Handover, WallsCountWhereTheyWereBuilt) {
  bim::Plan as_built = room();
  as_built.faces[0] = face_of(10, "south_a", {0, 0.3}, {2, 0.3});
  as_built.faces.erase(as_built.faces.begin() + 4);  // no west wall; a cupboard stands there
  EXPECT_TRUE(is_right(seen({0.5, 0.3}, {1.8, 0.3}, {10}), as_built));
  EXPECT_FALSE(is_right(seen({0.5, 0.0}, {1.8, 0.0}, {10}), as_built));
  EXPECT_FALSE(is_right(seen({0.0, 2.0}, {0.0, 1.0}, {14}), as_built));
}

TEST(Handover, TheWallSeenIsTheOneThatMostOfThePatchLiesOn) {
  const auto wall_of = [](const slam::WallMatch& match) { return walls_seen({match}, X_WR, room()).front(); };
  EXPECT_EQ(wall_of(seen({0.5, 0.0}, {1.8, 0.0}, {13})), "south_a");
  EXPECT_EQ(wall_of(seen({0.8, 0.0}, {3.9, 0.0}, {10})), "south_b");  // 1.9 of 3.1 m
  EXPECT_EQ(wall_of(seen({0.5, 0.12}, {1.8, 0.12}, {10})), "");       // 2 cm beyond the rule
  EXPECT_EQ(wall_of(seen({1.8, 0.0}, {0.5, 0.0}, {10})), "");         // the side that is in the wall
  EXPECT_TRUE(walls_seen({}, X_WR, room()).empty());
}

TEST(Handover, ShareAtTheFirstConvergence) {
  Truth truth{{{0, X_WR}, {400, X_WR}}, {0, 100, 200, 300}, {}};
  const slam::WallMatch good = seen({0.5, 0.0}, {1.8, 0.0}, {10}), bad = seen({0.5, 0.0}, {1.8, 0.0}, {13});
  const auto belief = [](slam::Nanoseconds stamp, slam::State state, std::vector<slam::WallMatch> walls) {
    return Belief{stamp, state, X_WR, {{1.0, X_WR, Eigen::Matrix3d::Zero(), "", std::move(walls)}}, {}};
  };
  const std::vector<Belief> beliefs = {belief(0, slam::State::searching, {bad}),
                                       belief(100, slam::State::converged, {good, good, bad, good}),
                                       belief(200, slam::State::converged, {bad})};
  EXPECT_EQ(handover_precision(truth, beliefs, room(), room()), 0.75);
  EXPECT_FALSE(handover_precision(truth, {beliefs[0]}, room(), room()));
  EXPECT_FALSE(handover_precision(truth, {belief(0, slam::State::converged, {})}, room(), room()));
  truth.set_down = 100;  // kidnapped before it had an answer
  EXPECT_FALSE(handover_precision(truth, beliefs, room(), room()));
}

TEST(Handover, IsAMetric) {
  MethodScore score;
  score.localization.emplace();
  const MetricRow* row = find_metric("localization.handover_precision");
  ASSERT_NE(row, nullptr);
  EXPECT_FALSE(row->value(score));
  score.localization->handover_precision = 0.75;
  EXPECT_EQ(row->value(score), 0.75);
  EXPECT_EQ(row->better, Better::higher);
  EXPECT_EQ(to_results(score).find("localization")->find("handover_precision")->as_double(), 0.75);
}

}  // namespace
}  // namespace plumbline::scenarios::score
