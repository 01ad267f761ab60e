// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/reference_axes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bim/random/stream.h"

namespace plumbline::scenarios::score {
namespace {

using Poses = std::vector<slam::StampedPose>;
constexpr slam::Nanoseconds tenth = 100'000'000;

/// A level bend of 80 poses, 0.3 m apart, the last ones straight on.
Poses bend() {
  Poses poses;
  Pose X = Pose::from_xyz_yaw({10.0, -20.0, 0.5}, 2.0);
  for (int i = 0; i < 80; ++i) {
    poses.push_back({i * tenth, X});
    Vector6d step;
    step << 0.3, 0.0, 0.0, 0.0, 0.0, i < 50 ? 0.04 : 0.0;
    X = X * exp_se3(step);
  }
  return poses;
}

Poses behind(Poses poses, const Pose& X_RB) {
  for (slam::StampedPose& pose : poses) pose.X_FR = pose.X_FR * X_RB;
  return poses;
}

/// The last column of a rotation is where the body's z axis points: a camera's, forward.
Eigen::Quaterniond camera() {
  Eigen::Matrix3d R;
  R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return Eigen::Quaterniond(R);
}

TEST(ReferenceAxes, OfACameraAreTurnedToTheRobots) {
  const Poses robot = bend();
  const auto turned = turned_to_robot(behind(robot, {camera(), {0.1, 0.0, 0.2}}), robot);
  ASSERT_TRUE(turned);
  // 0.1 m before R swings by 13 mm over each metre of the bend.
  EXPECT_NEAR(turned->turned_rad, 120.0 * std::numbers::pi / 180.0, 0.0134);
  EXPECT_LT(*score_by_reference(turned->reference_W, robot)->rpe_1m_rmse_m, 0.05);
  for (std::size_t i = 0; i < robot.size(); ++i)
    EXPECT_LT(turned->reference_W[i].X_FR.q.angularDistance(robot[i].X_FR.q), 0.06) << "0.1 m behind a bend of 7.5 m";
}

TEST(ReferenceAxes, AreFoundWhateverTheyAre) {
  const Stream stream(3, "bim.generate");
  const Poses robot = bend();
  for (std::uint64_t i = 0; i < 100; ++i) {
    Eigen::Vector4d q;
    for (std::uint32_t k = 0; k < 4; ++k) q[k] = stream.gauss(i, 0, k);
    const Eigen::Quaterniond q_RB = Eigen::Quaterniond(q).normalized();
    const Pose X_FW = Pose::from_xyz_yaw({3.0, 4.0, 0.0}, 0.1 * static_cast<double>(i));
    Poses reference = behind(robot, {q_RB, Eigen::Vector3d::Zero()});
    for (slam::StampedPose& pose : reference) pose.X_FR = X_FW * pose.X_FR;
    const auto as_read = score_by_reference(reference, robot);
    const auto turned = turned_to_robot(reference, robot);
    ASSERT_TRUE(as_read && as_read->rpe_1m_rmse_m);
    ASSERT_EQ(turned.has_value(), *as_read->rpe_1m_rmse_m >= AxesRules().least_error_m) << i;
    if (turned) {
      EXPECT_LT(*score_by_reference(turned->reference_W, robot)->rpe_1m_rmse_m, 1e-6) << i;
    }
  }
}

TEST(ReferenceAxes, ThatAreTheRobotsStayAndAWrongWayIsNoneOfThem) {
  const Poses robot = bend();
  EXPECT_FALSE(turned_to_robot(robot, robot));
  Poses other = robot;  // turned the other way: no rotation makes it so
  for (slam::StampedPose& pose : other) {
    pose.X_FR.t.y() = -pose.X_FR.t.y();
    pose.X_FR.q = Eigen::Quaterniond(pose.X_FR.q.w(), 0.0, 0.0, -pose.X_FR.q.z()) *
                  Eigen::Quaterniond(Eigen::AngleAxisd(2.0 * pose.X_FR.t.x(), Eigen::Vector3d::UnitZ()));
  }
  EXPECT_FALSE(turned_to_robot(other, robot));
}

TEST(ReferenceAxes, PositionsAloneAreToldFromAStraightWalk) {
  const Poses robot = bend();
  Poses positions = robot;
  for (slam::StampedPose& pose : positions) pose.X_FR.q = Eigen::Quaterniond::Identity();
  EXPECT_TRUE(is_without_orientation(positions, robot));
  EXPECT_FALSE(is_without_orientation(robot, robot));
  EXPECT_FALSE(is_without_orientation(positions, positions));
}

}  // namespace
}  // namespace plumbline::scenarios::score
