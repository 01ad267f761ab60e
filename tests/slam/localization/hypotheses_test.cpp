// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/hypotheses.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/slam/localization/house_plan.h"
#include "tests/slam/localization/house_scan.h"

namespace plumbline::slam {
namespace {

struct TwinScene {
  PlanIndex index;
  std::vector<View> views;
  std::vector<Pose2> u;
  Pose2 here, there;  ///< the true place and its twin at the first view
};

TwinScene twin_scene() {
  const synthetic::House house = synthetic::twin_rooms();
  TwinScene scene{make_plan_index(synthetic::plan_of(house), "ground", {}), {}, {}, {}, {}};
  for (int i = 0; i < 6; ++i) {
    const Pose X_WR = Pose::from_xyz_yaw({1.5 + 0.25 * i, 1.4, 0.46}, 0.2);
    scene.views.push_back(synthetic::standing_view(house, X_WR, Pose{}, static_cast<std::uint64_t>(i + 1)).view);
    const Pose2 X_IH = heading(scene.index.X_WI.inverse() * X_WR);
    const Pose2 before =
        i == 0 ? X_IH : heading(scene.index.X_WI.inverse() * Pose::from_xyz_yaw({1.25 + 0.25 * i, 1.4, 0.46}, 0.2));
    scene.u.push_back(before.inverse() * X_IH);
    if (i > 0) continue;
    scene.here = X_IH;
    scene.there = heading(scene.index.X_WI.inverse() * Pose::from_xyz_yaw({10.5, 2.4, 0.46}, 0.2));
  }
  return scene;
}

/// Follows the true place through all views, then adopts its twin.
void follow_and_adopt_twin(const TwinScene& scene, HypothesisSet& set) {
  set.follow(scene.index, scene.u[0], scene.views[0]);
  set.adopt(scene.index, std::vector<Place>{{0, scene.here}});
  for (std::size_t i = 1; i < scene.views.size(); ++i) set.follow(scene.index, scene.u[i], scene.views[i]);
  Pose2 twin = scene.there;
  for (std::size_t i = 1; i < scene.views.size(); ++i) twin = twin * scene.u[i];
  set.adopt(scene.index, std::vector<Place>{{0, twin}});
}

/// Adopts a place near the true one first and then others, at the first view.
void adopt_after_a_wrong_one(const TwinScene& scene, const Eigen::Vector2d& off_H, const std::vector<Place>& others,
                             HypothesisSet& set) {
  set.follow(scene.index, scene.u[0], scene.views[0]);
  Pose2 off = scene.here;
  off.t += off.rotation() * off_H;
  set.adopt(scene.index, std::vector<Place>{{0, off, true}});
  set.adopt(scene.index, others);
  set.settle();
}

TEST(Hypotheses, TwinsKeepEqualSharesAndOthersDie) {
  const TwinScene scene = twin_scene();
  HypothesisSet set({}, {}, {}, {});
  set.follow(scene.index, scene.u[0], scene.views[0]);
  Pose2 elsewhere = scene.here;
  elsewhere.t += Eigen::Vector2d(1.2, 0.9);
  set.adopt(scene.index, {{0, scene.here}, {0, scene.there}, {0, elsewhere}});
  for (std::size_t i = 1; i < scene.views.size(); ++i) {
    set.follow(scene.index, scene.u[i], scene.views[i]);
    set.settle();
  }
  ASSERT_EQ(set.candidates().size(), 2U);
  EXPECT_NEAR(set.candidates()[0].mass, 0.5, 1e-6);
}

TEST(Hypotheses, APlaceThatTurnsUpLateIsJudgedByTheWholeHistory) {
  const TwinScene scene = twin_scene();
  HypothesisSet set({}, {}, {}, {});
  follow_and_adopt_twin(scene, set);
  set.settle();
  ASSERT_EQ(set.candidates().size(), 2U);
  EXPECT_NEAR(set.candidates()[0].mass, 0.5, 1e-6);
}

TEST(Hypotheses, AWallThatWasNotBuiltSpeaksOnlyOnceAgainstAPlace) {
  // Planned: a partition in the room where the robot stands, which is not there; and a twin room without one.
  synthetic::House planned = synthetic::twin_rooms();
  planned.boxes.push_back({{3.4, 0.0, 0.0}, {3.5, 4.0, 2.8}});
  const TwinScene built = twin_scene();
  const PlanIndex index = make_plan_index(synthetic::plan_of(planned), "ground", {});
  const ContestConfig contest;
  HypothesisConfig config;
  config.drop_ratio = 1e6;
  HypothesisSet set(config, {}, {}, contest);
  set.follow(index, built.u[0], built.views[0]);
  set.adopt(index, {{0, built.here}, {0, built.there}});
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t i = 0; i < built.views.size(); ++i) {
      set.follow(index, {}, built.views[0]);
      set.settle();
    }
  ASSERT_EQ(set.candidates().size(), 2U);
  const double lead = set.candidates()[0].evidence - set.candidates()[1].evidence;
  EXPECT_LT((set.candidates()[0].X_IH.t - built.there.t).norm(), 0.2);
  EXPECT_GE(lead, contest.cause_cap);
  // Its near face, its far face through the first's end, and what is cut short before the wall behind.
  EXPECT_LE(lead, 4.0 * contest.cause_cap);
}

TEST(Hypotheses, APlaceThatTurnsUpLateFitsAsOftenAsOneFollowedAllTheWay) {
  const TwinScene scene = twin_scene();
  HypothesisConfig config;
  config.replay_stride = 1;
  HypothesisSet set(config, {}, {}, {});
  follow_and_adopt_twin(scene, set);
  ASSERT_EQ(set.candidates().size(), 2U);
  EXPECT_EQ(set.candidates()[0].fits, static_cast<int>(scene.views.size()));
  EXPECT_EQ(set.candidates()[1].fits, static_cast<int>(scene.views.size()));
}

TEST(Hypotheses, ThatNothingFittedBeforeIsHeldAgainstAPlace) {
  const TwinScene scene = twin_scene();
  const View elsewhere =
      synthetic::standing_view(synthetic::one_room(9.0, 7.0), Pose::from_xyz_yaw({1.5, 5.8, 0.46}, 0.2), Pose{}).view;
  const HypothesisConfig config;
  HypothesisSet set(config, {}, {}, {});
  for (int i = 0; i < 20; ++i) set.follow(scene.index, {}, elsewhere);
  set.follow(scene.index, {}, scene.views[0]);
  set.adopt(scene.index, std::vector<Place>{{0, scene.here}});
  ASSERT_EQ(set.candidates().size(), 1U);
  EXPECT_LT(set.candidates()[0].fits, -10);
  EXPECT_GE(set.candidates()[0].fits, config.least_fits);
}

// Where clutter hides a wall, the place as it would be with the clutter's front for the wall is 0.5 m off.
TEST(Hypotheses, APlaceHalfAMetreFromAKnownOneIsTriedToo) {
  const TwinScene scene = twin_scene();
  HypothesisConfig config;
  config.drop_ratio = 1e6;
  HypothesisSet set(config, {}, {}, {});
  adopt_after_a_wrong_one(scene, {0.4, 0.4}, {{0, scene.here, true}}, set);
  ASSERT_EQ(set.candidates().size(), 2U);
  EXPECT_LT((set.candidates()[0].X_IH.t - scene.here.t).norm(), 0.1);
}

// Two places win over the one that all are held against; they are told apart by what each saw, not by how far each won.
TEST(Hypotheses, OnlyTheDirectComparisonCounts) {
  const TwinScene scene = twin_scene();
  HypothesisConfig config;
  config.drop_ratio = 1e6;
  HypothesisSet set(config, {}, {}, {});
  adopt_after_a_wrong_one(scene, {0.9, 0.6}, {{0, scene.here, true}, {0, scene.there, true}}, set);
  ASSERT_EQ(set.candidates().size(), 3U);
  EXPECT_EQ(set.candidates()[0].evidence, set.candidates()[1].evidence);
  EXPECT_LT(set.candidates()[2].evidence, -5.0);
}

// The first is far behind the second, against which nothing has been held yet.
TEST(Hypotheses, ThePlaceThatAllAreHeldAgainstIsKeptUntilTheyAreHeldAgainstAnother) {
  const TwinScene scene = twin_scene();
  HypothesisConfig config;
  config.overtaking = 1e6;
  config.drop_ratio = 5.0;
  HypothesisSet set(config, {}, {}, {});
  adopt_after_a_wrong_one(scene, {0.9, 0.6}, {{0, scene.here, true}}, set);
  ASSERT_EQ(set.candidates().size(), 2U);
  EXPECT_GT(set.candidates()[0].evidence, config.drop_ratio);
  EXPECT_EQ(set.candidates()[1].evidence, 0.0);
  set.follow(scene.index, scene.u[1], scene.views[1]);
  EXPECT_EQ(set.candidates()[1].evidence, 0.0);
}

TEST(Hypotheses, ImposeGivesEachPlaceItsMassAndBringsBackTheLost) {
  const TwinScene scene = twin_scene();
  HypothesisSet set({}, {}, {}, {});
  set.follow(scene.index, scene.u[0], scene.views[0]);
  set.adopt(scene.index, {{0, scene.here}, {0, scene.there}});
  set.settle();
  // Every particle stands at one of the twins.
  ParticleSet particles(200, {scene.here, 0, 1.0 / 200, -1});
  const Clustering clustering = find_clusters(particles, {});
  set.impose(particles, clustering, 100, 3, 1);
  double mass = 0.0;
  for (const LocalParticle& p : particles)
    if ((p.X_IH.t - scene.there.t).norm() < 0.5) mass += p.weight;
  EXPECT_NEAR(mass, 0.5, 0.01);
}

}  // namespace
}  // namespace plumbline::slam
