// SPDX-License-Identifier: Apache-2.0
#include "sim/pose_track.h"

#include <gtest/gtest.h>

#include "bim/errors.h"

namespace plumbline::sim {
namespace {

PoseTrack three_poses() {
  PoseTrack track;
  for (int i = 0; i < 3; ++i) track.add(1000 * i, Pose::from_xyz_yaw({0.1 * i, 0.0, 0.0}, 0.2 * i));
  return track;
}

TEST(PoseTrack, InterpolatesBetweenNeighbours) {
  const Pose X = three_poses().at(1250);
  EXPECT_NEAR(X.t.x(), 0.125, 1e-15);
  EXPECT_NEAR(X.yaw(), 0.25, 1e-15);
}

TEST(PoseTrack, KnownTimesAreExact) { EXPECT_EQ(three_poses().at(2000).t.x(), 0.2); }

TEST(PoseTrack, RefusesTimesOutside) {
  const PoseTrack track = three_poses();
  EXPECT_THROW(static_cast<void>(track.at(-1)), InternalError);
  EXPECT_THROW(static_cast<void>(track.at(2001)), InternalError);
  EXPECT_THROW(static_cast<void>(PoseTrack().at(0)), InternalError);
}

TEST(PoseTrack, ForgettingKeepsWhatLaterTimesNeed) {
  PoseTrack track = three_poses();
  track.forget_before(1500);
  EXPECT_NEAR(track.at(1500).t.x(), 0.15, 1e-15);
  EXPECT_THROW(static_cast<void>(track.at(900)), InternalError);
}

TEST(PoseTrack, RefusesTimeThatDoesNotAscend) {
  PoseTrack track = three_poses();
  EXPECT_THROW(track.add(2000, Pose{}), InternalError);
}

}  // namespace
}  // namespace plumbline::sim
