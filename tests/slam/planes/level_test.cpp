// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/level.h"

#include <gtest/gtest.h>

#include <vector>

#include "slam/planes/observe.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

/// Planes seen in a room by a sensor that is mounted tilted.
std::vector<PlaneObservation> seen_tilted(const Eigen::Quaterniond& q_WR) {
  const Pose X_WR = Pose::from_xyz_yaw({3.0, 2.0, 0.5}, 0.3) * Pose{q_WR, Eigen::Vector3d::Zero()};
  MotionBuffer motion;
  motion.add({0, Pose{}});
  const Scan scan = synthetic::standing_scan(synthetic::one_room(), X_WR, {});
  return observe_planes(deskew(scan, motion, synthetic::calibration()), {}, RinglessRansacConfig(), 1);
}

double tilt_after(const Eigen::Quaterniond& q_WR, const std::vector<PlaneObservation>& seen) {
  const Eigen::Vector3d up_R = q_WR.conjugate() * Eigen::Vector3d::UnitZ();
  return std::acos(std::min(1.0, (level_by_planes(seen) * up_R).z()));
}

TEST(Level, AFloorTellsWhatIsUp) {
  const Eigen::Quaterniond q_WR(Eigen::AngleAxisd(0.1, Eigen::Vector3d(0.6, 0.8, 0.0)));
  const std::vector<PlaneObservation> seen = seen_tilted(q_WR);
  ASSERT_TRUE(std::any_of(seen.begin(), seen.end(), is_floor));
  EXPECT_LT(tilt_after(q_WR, seen), 0.01);
}

// A LiDAR in a small room may see neither floor nor ceiling.
TEST(Level, WallsOfTwoDirectionsDoWhereNoFloorIsSeen) {
  const Eigen::Quaterniond q_WR(Eigen::AngleAxisd(0.1, Eigen::Vector3d(0.6, 0.8, 0.0)));
  std::vector<PlaneObservation> seen = seen_tilted(q_WR);
  std::erase_if(seen, [](const PlaneObservation& plane) { return !plane.vertical; });
  ASSERT_GE(seen.size(), 3U);
  EXPECT_LT(tilt_after(q_WR, seen), 0.02);
  const Eigen::Vector3d n_R = seen.front().plane_R.n;
  std::erase_if(seen, [&](const PlaneObservation& plane) { return std::abs(plane.plane_R.n.dot(n_R)) < 0.5; });
  EXPECT_FALSE(up_by_planes(seen).has_value()) << "walls of one direction leave the tilt along them open";
  EXPECT_FALSE(up_by_planes({}).has_value());
}

}  // namespace
}  // namespace plumbline::slam
