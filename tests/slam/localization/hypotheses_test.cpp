// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/hypotheses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "slam/localization/global_localizer.h"
#include "tests/slam/localization/twin_rooms.h"

namespace plumbline::slam {
namespace {

/// The true pose, tracked, and its twin, for which every scan was replayed.
HypothesisSet both_twins(const TwinRooms& twins) {
  HypothesisConfig config;
  config.replay_stride = 1;
  HypothesisSet set(config, {}, {}, {});
  track_and_add_twin(twins, set);
  return set;
}

/// Adds a pose near the true one first and then others, at the first scan.
void add_after_a_wrong_one(const TwinRooms& twins, const Eigen::Vector2d& off_H, const std::vector<StoreyPose>& others,
                           HypothesisSet& set) {
  set.predict_and_update(twins.index, twins.u[0], twins.scans[0]);
  Pose2 off = twins.here;
  off.t += off.rotation() * off_H;
  set.add(twins.index, std::vector<StoreyPose>{{0, off, true}});
  set.add(twins.index, others);
  set.prune_and_normalize();
}

// Poses of one direction would take the leader's mass, each a little.
TEST(Hypotheses, OfPosesInOneDirectionTheLikeliestIsAdded) {
  const TwinRooms twins = twin_rooms_scans();
  HypothesisSet set({}, {}, {}, {});
  set.predict_and_update(twins.index, twins.u[0], twins.scans[0]);
  Pose2 off = twins.there;
  off.t.x() += 0.5;
  set.add(twins.index, std::vector<StoreyPose>{{0, off, true}});
  ASSERT_FALSE(set.all().empty());
  const std::size_t known = set.all().size();
  set.add_best(twins.index, {{0, off, true}, {0, twins.here, true}, {0, twins.there, true}});
  ASSERT_EQ(set.all().size(), known + 1);
  EXPECT_TRUE(is_near(set.all().back().X_IH, twins.here, 0.02, 0.02) ||
              is_near(set.all().back().X_IH, twins.there, 0.02, 0.02));
}

// As in a corridor: the faces across it are beyond the gate, and those along it say nothing of the way.
TEST(Hypotheses, APoseOffAlongAnOpenDirectionIsMovedWhereTheScanFits) {
  const TwinRooms twins = twin_rooms_scans();
  for (const double off_m : {-0.29, 0.28}) {
    const HypothesisConfig config;
    HypothesisSet set(config, {}, {}, {});
    set.predict_and_update(twins.index, twins.u[0], twins.scans[0]);
    Pose2 off = twins.here;
    off.t.x() += off_m;
    set.add(twins.index, std::vector<StoreyPose>{{0, off, true}, {0, twins.there, true}});
    const auto error = [&] {
      double least = 1e9;
      for (const PoseHypothesis& h : set.all()) least = std::min(least, (h.X_IH.t - twins.here.t).norm());
      return least;
    };
    EXPECT_GT(error(), 0.2);
    set.reassess(twins.index);
    EXPECT_LT(error(), 0.03);
  }
}

// A hypothesis pulled aside, as by furniture, would lose against the twin of the pose that it should have.
TEST(Hypotheses, APoseNearAKnownOneTakesItsPlaceWhereItFitsBetter) {
  const TwinRooms twins = twin_rooms_scans();
  HypothesisSet set({}, {}, {}, {});
  set.predict_and_update(twins.index, twins.u[0], twins.scans[0]);
  Pose2 off = twins.here;
  off.t.x() -= 0.28;
  set.add(twins.index, std::vector<StoreyPose>{{0, off, true}});
  set.add(twins.index, std::vector<StoreyPose>{{0, twins.there, true}});
  set.prune_and_normalize();
  EXPECT_TRUE(std::none_of(set.all().begin(), set.all().end(), [&](const PoseHypothesis& h) {
    return (h.X_IH.t - twins.here.t).norm() < 0.2 && h.mass > 0.4;
  }));
  set.add(twins.index, std::vector<StoreyPose>{{0, twins.here, true}});
  set.prune_and_normalize();
  ASSERT_EQ(set.all().size(), 2U);
  for (const Pose2& expected : {twins.here, twins.there})
    EXPECT_TRUE(std::any_of(set.all().begin(), set.all().end(), [&](const PoseHypothesis& h) {
      return (h.X_IH.t - expected.t).norm() < 0.03 && std::abs(h.mass - 0.5) < 1e-6;
    }));
}

TEST(Hypotheses, AnAliasTakesThePlaceOfOneThatWasPulledAside) {
  const TwinRooms twins = twin_rooms_scans();
  HypothesisSet set({}, {}, {}, {});
  set.predict_and_update(twins.index, twins.u[0], twins.scans[0]);
  set.add(twins.index, std::vector<StoreyPose>{{0, twins.here, true}});
  Pose2 aside = twins.there;
  aside.t.x() += 0.29;
  set.add(twins.index, std::vector<StoreyPose>{{0, aside, true}});
  set.prune_and_normalize();
  ASSERT_EQ(set.all().size(), 2U);
  EXPECT_GT(set.all()[0].mass, 0.6);
  set.add(twins.index, std::vector<StoreyPose>{{0, twins.there, true}});
  set.prune_and_normalize();
  ASSERT_EQ(set.all().size(), 2U);
  EXPECT_NEAR(set.all()[0].mass, 0.5, 1e-6);
}

TEST(Hypotheses, TheFitAlongThePathToThePresentPoseIsTheTrackedOneWhereThePoseWasRight) {
  const TwinRooms twins = twin_rooms_scans();
  HypothesisSet set = both_twins(twins);
  set.prune_and_normalize();
  const PoseHypothesis tracked = set.all().front();
  set.replay_best_agreement(twins.index);
  EXPECT_EQ(set.all().front().scans, static_cast<int>(twins.scans.size()));
  EXPECT_NEAR(set.all().front().fit_sum, tracked.fit_sum, 0.05 * tracked.fit_sum);
  set.replay_best_agreement(twins.index);
  EXPECT_EQ(set.all().front().scans, static_cast<int>(twins.scans.size()));
}

TEST(Hypotheses, TwinsKeepEqualSharesAndOthersHaveNone) {
  const TwinRooms twins = twin_rooms_scans();
  HypothesisSet set({}, {}, {}, {});
  set.predict_and_update(twins.index, twins.u[0], twins.scans[0]);
  Pose2 elsewhere = twins.here;
  elsewhere.t += Eigen::Vector2d(1.2, 0.9);
  set.add(twins.index, {{0, twins.here}, {0, twins.there}, {0, elsewhere}});
  for (std::size_t i = 1; i < twins.scans.size(); ++i) {
    set.predict_and_update(twins.index, twins.u[i], twins.scans[i]);
    set.prune_and_normalize();
  }
  ASSERT_GE(set.all().size(), 2U);
  for (std::size_t i = 0; i < set.all().size(); ++i) EXPECT_NEAR(set.all()[i].mass, i < 2 ? 0.5 : 0.0, 1e-6);
}

TEST(Hypotheses, ALateHypothesisReplaysTheWholeHistory) {
  const TwinRooms twins = twin_rooms_scans();
  HypothesisSet set({}, {}, {}, {});
  track_and_add_twin(twins, set);
  set.prune_and_normalize();
  ASSERT_EQ(set.all().size(), 2U);
  EXPECT_NEAR(set.all()[0].mass, 0.5, 1e-6);
}

/// What a robot sees that is blindfolded.
LocalizationScan blind(LocalizationScan scan) {
  scan.beams.clear();
  scan.walls.clear();
  for (BeamGridBlock& block : scan.beam_grid.blocks) block.range = all(0.0F);
  return scan;
}

/// Lead of the true pose over one elsewhere by a single scan after several that tell nothing; the other pose is tracked
/// from the start, or added at the end.
double lead_by_one_scan(bool late) {
  const TwinRooms twins = twin_rooms_scans();
  HypothesisConfig config;
  config.drop_ratio = config.step_cap = 1e6;
  HypothesisComparisonConfig comparison;
  comparison.cause_cap = comparison.object_cap = comparison.outlined_cap = 1e6;
  HypothesisSet set(config, {}, {}, comparison);
  Pose2 elsewhere = twins.here;
  elsewhere.t += Eigen::Vector2d(1.2, 0.9);
  for (int i = 0; i < 5; ++i) {
    set.predict_and_update(twins.index, {}, blind(twins.scans[0]));
    if (i > 0) continue;
    set.add(twins.index, std::vector<StoreyPose>{{0, twins.here, true}});
    if (!late) set.add(twins.index, std::vector<StoreyPose>{{0, elsewhere, true}});
  }
  set.predict_and_update(twins.index, {}, twins.scans[0]);
  if (late) set.add(twins.index, std::vector<StoreyPose>{{0, elsewhere, true}});
  double least = 0.0;
  for (const PoseHypothesis& hypothesis : set.all()) least = std::min(least, hypothesis.evidence);
  return -least;
}

// A scan of a turn may be off. It must not stand for the two before it.
TEST(Hypotheses, OneScanCountsOnceInAShortHistory) {
  const double tracked = lead_by_one_scan(false);
  EXPECT_GT(tracked, 1.0);
  EXPECT_NEAR(lead_by_one_scan(true), tracked, 0.5 * tracked);
}

TEST(Hypotheses, AWallThatWasNotBuiltDoesNotDecideAlone) {
  // Planned: a partition in the room where the robot stands, which is not there; and a twin room without one.
  synthetic::House planned = synthetic::twin_rooms();
  planned.boxes.push_back({{3.4, 0.0, 0.0}, {3.5, 4.0, 2.8}});
  const TwinRooms built = twin_rooms_scans();
  const PlanIndex index = make_plan_index(synthetic::plan_of(planned), "ground", {});
  const HypothesisComparisonConfig comparison;
  HypothesisConfig config;
  config.drop_ratio = 1e6;
  HypothesisSet set(config, {}, {}, comparison);
  set.predict_and_update(index, built.u[0], built.scans[0]);
  set.add(index, {{0, built.here}, {0, built.there}});
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t i = 0; i < built.scans.size(); ++i) {
      set.predict_and_update(index, {}, built.scans[0]);
      set.prune_and_normalize();
    }
  ASSERT_EQ(set.all().size(), 2U);
  const double lead = set.all()[0].evidence - set.all()[1].evidence;
  EXPECT_LT((set.all()[0].X_IH.t - built.there.t).norm(), 0.2);
  EXPECT_NEAR(lead, comparison.missing_wall_cap, 0.5) << "however often it is seen";
  EXPECT_LT(lead, ConvergenceConfig{}.log_ratio);
}

TEST(Hypotheses, ALateHypothesisFitsAsOftenAsATrackedOne) {
  const TwinRooms twins = twin_rooms_scans();
  HypothesisSet set = both_twins(twins);
  ASSERT_EQ(set.all().size(), 2U);
  EXPECT_EQ(set.all()[0].scans, static_cast<int>(twins.scans.size()));
  EXPECT_EQ(set.all()[1].scans, static_cast<int>(twins.scans.size()));
  EXPECT_NEAR(set.all()[1].fit, set.all()[0].fit, 1.0);
}

TEST(Hypotheses, ScansThatDidNotFitBeforeCount) {
  const TwinRooms twins = twin_rooms_scans();
  const LocalizationScan elsewhere =
      synthetic::house_scan(synthetic::one_room(9.0, 7.0), Pose::from_xyz_yaw({1.5, 5.8, 0.46}, 0.2), Pose{}).scan;
  const HypothesisConfig config;
  HypothesisSet set(config, {}, {}, {});
  const Pose2 step{{config.fit.whole_step_m, 0.0}, 0.0};
  for (int i = 0; i < 20; ++i) set.predict_and_update(twins.index, step, elsewhere);
  set.predict_and_update(twins.index, step, twins.scans[0]);
  set.add(twins.index, std::vector<StoreyPose>{{0, twins.here}});
  ASSERT_EQ(set.all().size(), 1U);
  EXPECT_LT(set.all()[0].fit, -10.0);
  EXPECT_GE(set.all()[0].fit, -config.fit.limit);
}

// Where clutter hides a wall, the pose that takes the clutter's front for the wall is 0.5 m off.
TEST(Hypotheses, APoseHalfAMetreFromAKnownOneIsTriedToo) {
  const TwinRooms twins = twin_rooms_scans();
  HypothesisConfig config;
  config.drop_ratio = 1e6;
  HypothesisSet set(config, {}, {}, {});
  add_after_a_wrong_one(twins, {0.4, 0.4}, {{0, twins.here, true}}, set);
  ASSERT_EQ(set.all().size(), 2U);
  EXPECT_LT((set.all()[0].X_IH.t - twins.here.t).norm(), 0.1);
}

// Two hypotheses beat the reference; they are compared with each other, not by how far each beat it.
TEST(Hypotheses, OnlyTheDirectComparisonCounts) {
  const TwinRooms twins = twin_rooms_scans();
  HypothesisConfig config;
  config.drop_ratio = 1e6;
  HypothesisSet set(config, {}, {}, {});
  add_after_a_wrong_one(twins, {0.9, 0.6}, {{0, twins.here, true}, {0, twins.there, true}}, set);
  ASSERT_EQ(set.all().size(), 3U);
  EXPECT_EQ(set.all()[0].evidence, set.all()[1].evidence);
  EXPECT_LT(set.all()[2].evidence, -5.0);
}

// The first is far behind the second, against which nothing has been held yet.
TEST(Hypotheses, TheReferenceIsKeptUntilANewOneIsCompared) {
  const TwinRooms twins = twin_rooms_scans();
  HypothesisConfig config;
  config.reference_switch_margin = 1e6;
  config.drop_ratio = 5.0;
  HypothesisSet set(config, {}, {}, {});
  add_after_a_wrong_one(twins, {0.9, 0.6}, {{0, twins.here, true}}, set);
  ASSERT_EQ(set.all().size(), 2U);
  EXPECT_GT(set.all()[0].evidence, config.drop_ratio);
  EXPECT_EQ(set.all()[1].evidence, 0.0);
  set.predict_and_update(twins.index, twins.u[1], twins.scans[1]);
  EXPECT_EQ(set.all()[1].evidence, 0.0);
}

TEST(Hypotheses, ReweightingGivesEachHypothesisItsMassAndNewParticles) {
  const TwinRooms twins = twin_rooms_scans();
  HypothesisSet set({}, {}, {}, {});
  set.predict_and_update(twins.index, twins.u[0], twins.scans[0]);
  set.add(twins.index, {{0, twins.here}, {0, twins.there}});
  set.prune_and_normalize();
  // Every particle stands at one of the twins.
  ParticleSet particles(200, {twins.here, 0, 1.0 / 200, -1});
  const Clustering clustering = find_clusters(particles, {});
  set.reweight_particles(particles, clustering, 100, 3, 1);
  double mass = 0.0;
  for (const LocalParticle& p : particles)
    if ((p.X_IH.t - twins.there.t).norm() < 0.5) mass += p.weight;
  EXPECT_NEAR(mass, 0.5, 0.01);
}

TEST(Hypotheses, TurningOnTheSpotAddsNothingToHowWellThePlanFits) {
  const TwinRooms twins = twin_rooms_scans();
  HypothesisSet set = both_twins(twins);
  set.prune_and_normalize();
  const PoseHypothesis walked = set.all().front();
  for (int i = 0; i < 20; ++i) set.predict_and_update(twins.index, {}, twins.scans.back());
  EXPECT_EQ(set.all().front().fit_sum, walked.fit_sum);
  EXPECT_EQ(set.all().front().scans, walked.scans);
  set.replay_best_agreement(twins.index);
  EXPECT_NEAR(set.all().front().fit_sum, walked.fit_sum, 0.05 * walked.fit_sum);
  EXPECT_EQ(set.all().front().scans, walked.scans);
  const Pose2 half{{0.5 * FitConfig().whole_step_m, 0.0}, 0.0};
  set.predict_and_update(twins.index, half, twins.scans.back());
  EXPECT_NEAR(set.all().front().scans, walked.scans + 0.5, 1e-9);
}

TEST(FitConfig, ScansThatPenetrateCountAgainstAPose) {
  const FitConfig config;
  EXPECT_NEAR(config.of_scan({0.5, 0.0, 0.0}), 1.0, 1e-12);
  EXPECT_EQ(config.of_scan({0.95, 0.01, 0.0}), config.most_a_scan);
  EXPECT_EQ(config.of_scan({0.05, 0.0, 0.0}), -config.doubtful_scan);
  EXPECT_EQ(config.of_scan({0.2, 0.05, 0.04}), -config.doubtful_scan);
  // Behind clutter few beams reach the walls.
  EXPECT_EQ(config.of_scan({0.2, 0.0, 0.0}), 0.0);
  // One wall that is missing explains all that penetrate.
  EXPECT_EQ(config.of_scan({0.5, 0.2, 0.2}), config.missing_wall_scan);
  EXPECT_EQ(config.of_scan({0.5, 0.2, 0.1}), -config.misfit_scan);
}

TEST(FitConfig, BehindClutterTheBeamsThatReachTheWallsCount) {
  const FitConfig config;
  const double few = 0.5 * (config.inliers_doubtful + config.inliers_min);
  const FitConfig::Count clear = config.count_of({few, config.clear_penetration, 0.01});
  EXPECT_NEAR(clear.fit, few / config.inliers_full, 1e-12);
  EXPECT_NEAR(clear.scans, few / config.inliers_min, 1e-12) << "its mean is that of the poorest scan that fits";
  const FitConfig::Count pierced = config.count_of({few, 1.1 * config.clear_penetration, 0.011});
  EXPECT_EQ(pierced.fit, 0.0);
  for (const Agreement& seen : {Agreement{0.6, 0.0, 0.0}, Agreement{0.05, 0.0, 0.0}, Agreement{0.5, 0.2, 0.1}}) {
    EXPECT_EQ(config.count_of(seen).fit, config.of_scan(seen));
    EXPECT_EQ(config.count_of(seen).scans, 1.0);
  }
  FitConfig any;
  any.inliers_doubtful = any.inliers_min = any.doubtful_scan = 0.0;
  EXPECT_EQ(any.count_of({0.0, 0.0, 0.0}).scans, 1.0);
}

TEST(FitConfig, MoreBeamsOnTheirFacesNeverCountLess) {
  const FitConfig config;
  double before = config.count_of({0.0, 0.0, 0.0}).fit;
  for (double inliers = 0.001; inliers <= 1.0; inliers += 0.001) {
    const double fit = config.count_of({inliers, 0.0, 0.0}).fit;
    EXPECT_GE(fit, before) << inliers;
    before = fit;
  }
}

}  // namespace
}  // namespace plumbline::slam
