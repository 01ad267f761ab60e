// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/range_bias.h"

#include <gtest/gtest.h>

#include <cmath>

#include "slam/localization/associate.h"
#include "slam/localization/tracker_factors.h"
#include "tests/slam/localization/house_plan.h"
#include "tests/slam/localization/house_scan.h"

namespace plumbline::slam {
namespace {

class RangeBiasInTheCorridor : public ::testing::Test {
 protected:
  RangeBiasInTheCorridor()
      : house_(synthetic::corridor_house()), index_(make_plan_index(synthetic::plan_of(house_), "ground", {})) {}

  [[nodiscard]] const StoreyIndex& storey() const { return index_.storeys.front(); }
  /// The walls seen from a place in the corridor by a LiDAR that measures too far by bias_m.
  [[nodiscard]] TrackedPose pose_at(double x, double bias_m) const {
    const Pose X_WR = Pose::from_xyz_yaw({x, 1.0, 0.46}, 0.1);
    const synthetic::HouseScan seen = synthetic::house_scan(house_, X_WR, {}, static_cast<std::uint64_t>(100.0 * x));
    TrackedPose pose;
    pose.X_IR = index_.X_WI.inverse() * X_WR;
    pose.walls = associate_walls(storey(), seen.scan, seen.planes, pose.X_IR, Eigen::Matrix2d::Zero(), config_);
    for (WallLink& link : pose.walls) link.observed.plane_R.d += bias_m * bias_share(link.observed);
    return pose;
  }
  /// The same, but only the walls that face one way.
  [[nodiscard]] TrackedPose one_sided_pose_at(double x, double bias_m) const {
    TrackedPose pose = pose_at(x, bias_m);
    const Eigen::Vector2d n = storey().lines[static_cast<std::size_t>(pose.walls.front().line)].n;
    std::erase_if(pose.walls, [&](const WallLink& link) {
      return storey().lines[static_cast<std::size_t>(link.line)].n.dot(n) < 0.9;
    });
    return pose;
  }

  synthetic::House house_;
  PlanIndex index_;
  TrackerConfig config_;
};

TEST_F(RangeBiasInTheCorridor, IsFoundByWallsThatFaceEachOther) {
  RangeBias bias(config_.range_bias_sigma_m);
  for (int i = 0; i < 12; ++i) bias.add(pose_at(3.0 + 0.2 * i, 0.03), storey(), 1.0, config_);
  // The prior holds back a twelfth of it or less; the rest is the noise of the fits.
  EXPECT_NEAR(bias.mean(), 0.03, 0.005);
  EXPECT_LT(std::sqrt(bias.variance()), 0.01);
}

// It ran off by 8 cm along a corridor whose end behind the robot was all that held the position.
TEST_F(RangeBiasInTheCorridor, WallsOfOneSideTellNothingOfIt) {
  RangeBias bias(config_.range_bias_sigma_m);
  for (int i = 0; i < 12; ++i) bias.add(one_sided_pose_at(3.0 + 0.2 * i, 0.05), storey(), 1.0, config_);
  EXPECT_LT(std::abs(bias.mean()), 0.003);
  EXPECT_GT(std::sqrt(bias.variance()), 0.9 * config_.range_bias_sigma_m);
}

TEST_F(RangeBiasInTheCorridor, ASharePartTellsLess) {
  RangeBias whole(config_.range_bias_sigma_m), part(config_.range_bias_sigma_m);
  const TrackedPose pose = pose_at(3.0, 0.03);
  whole.add(pose, storey(), 1.0, config_);
  part.add(pose, storey(), 0.1, config_);
  EXPECT_LT(whole.variance(), part.variance());
  EXPECT_LT(std::abs(part.mean()), std::abs(whole.mean()));
}

}  // namespace
}  // namespace plumbline::slam
