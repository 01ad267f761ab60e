// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/silence.h"

#include <gtest/gtest.h>

namespace plumbline::scenarios::score {
namespace {

using Poses = std::vector<slam::StampedPose>;
constexpr slam::Nanoseconds tenth = 100'000'000;

/// Along x at 0.5 m a pose, ten poses a second, from stamp 1 s on.
Poses line(int count) {
  Poses poses;
  for (int i = 0; i < count; ++i) poses.push_back({(i + 10) * tenth, Pose::from_xyz_yaw({0.5 * i, 2.0, 1.0}, 0.3)});
  return poses;
}

/// The same in a frame of its own, and off to the side by 2 m from pose `first` to before pose `end`.
Poses off(const Poses& poses_W, std::size_t first, std::size_t end) {
  Vector6d xi;
  xi << 30.0, -4.0, 2.0, 0.1, 0.2, -2.5;
  Poses poses = poses_W;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i >= first && i < end) poses[i].X_FR.t.y() += 2.0;
    poses[i].X_FR = exp_se3(xi) * poses[i].X_FR;
  }
  return poses;
}

slam::Nanoseconds stamp(int pose) { return (pose + 10) * tenth; }

TEST(Silence, AMethodThatIsRightIsNeverSilent) {
  const Poses truth = line(40);
  const auto silence = score_silence(truth, off(truth, 40, 40), {});
  ASSERT_TRUE(silence);
  EXPECT_EQ(silence->silent_s, 0.0);
  EXPECT_FALSE(silence->off_at_s);
  EXPECT_FALSE(silence->said_after_s);
}

TEST(Silence, LastsFromTheErrorToTheEnd) {
  const Poses truth = line(40);
  const auto silence = score_silence(truth, off(truth, 15, 40), {});
  EXPECT_DOUBLE_EQ(silence->silent_s, 2.4);  // poses 15 to 39
  EXPECT_DOUBLE_EQ(*silence->off_at_s, 1.5);
  EXPECT_FALSE(silence->said_after_s);
}

TEST(Silence, EndsWithTheErrorAndTheLongestCounts) {
  const Poses truth = line(60);
  Poses poses = off(truth, 10, 15);
  const Poses later = off(truth, 30, 42);
  for (std::size_t i = 30; i < 42; ++i) poses[i] = later[i];
  const auto silence = score_silence(truth, poses, {});
  EXPECT_DOUBLE_EQ(silence->silent_s, 1.2);
  EXPECT_DOUBLE_EQ(*silence->off_at_s, 1.0);
}

TEST(Silence, EndsWhenTheMethodSaysThatItIsLost) {
  const Poses truth = line(60);
  const Poses poses = off(truth, 20, 60);
  const auto silence = score_silence(truth, poses, {{stamp(25), stamp(59)}});
  EXPECT_DOUBLE_EQ(silence->silent_s, 0.5);
  EXPECT_DOUBLE_EQ(*silence->said_after_s, 0.5);
  // Lost before the error grew, as is said of a robot that was set down elsewhere.
  const auto warned = score_silence(truth, poses, {{stamp(5), stamp(8)}, {stamp(18), stamp(59)}});
  EXPECT_EQ(warned->silent_s, 0.0);
  EXPECT_EQ(*warned->said_after_s, 0.0);
  // Found again without being right.
  const auto found = score_silence(truth, poses, {{stamp(21), stamp(30)}});
  EXPECT_DOUBLE_EQ(found->silent_s, 2.8);  // from pose 31 on
  EXPECT_DOUBLE_EQ(*found->said_after_s, 0.1);
  // A word that is over when the error comes is none.
  EXPECT_FALSE(score_silence(truth, poses, {{stamp(5), stamp(19)}})->said_after_s);
}

TEST(Silence, AScanWithoutAPoseMayEndIt) {
  const Poses truth = line(60);
  Poses poses = off(truth, 20, 60);
  poses.erase(poses.begin() + 30, poses.begin() + 40);
  const auto silence = score_silence(truth, poses, {{stamp(32), stamp(39)}});
  EXPECT_DOUBLE_EQ(silence->silent_s, 1.9);  // from pose 40 to 59; the first lasts 1.2 s
  EXPECT_DOUBLE_EQ(*silence->said_after_s, 1.2);
}

TEST(Silence, ItTakesMoreThanTheRule) {
  const Poses truth = line(40);
  const Poses poses = off(truth, 15, 40);
  SilenceRules rules;
  rules.most_error_m = 2.01;
  EXPECT_FALSE(score_silence(truth, poses, {}, rules)->off_at_s);
}

TEST(Silence, OfSlowScansBesideADenseReference) {
  const Poses truth = line(61);
  const Poses all = off(truth, 20, 61);
  Poses slow;
  for (std::size_t i = 0; i < all.size(); i += 5) slow.push_back(all[i]);
  const auto silence = score_silence(truth, slow, {});
  EXPECT_DOUBLE_EQ(*silence->off_at_s, 2.0);
  EXPECT_DOUBLE_EQ(silence->silent_s, 4.0);
}

TEST(Silence, NeedsAPoseAtATimeOfTheReference) {
  const Poses truth = line(10);
  Poses later = truth;
  for (slam::StampedPose& pose : later) pose.stamp += 1000 * tenth;
  EXPECT_FALSE(score_silence(truth, later, {}));
  EXPECT_FALSE(score_silence({}, truth, {}));
  EXPECT_FALSE(score_silence(truth, {}, {}));
}

}  // namespace
}  // namespace plumbline::scenarios::score
