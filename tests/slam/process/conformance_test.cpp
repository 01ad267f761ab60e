// SPDX-License-Identifier: Apache-2.0
#include "slam/process/conformance.h"

#include <gtest/gtest.h>

#include <functional>

#include "slam/process/trial_walk.h"

namespace plumbline::slam {
namespace {

/// Poses of the trial walk's scans as f makes them of the robot's in W.
std::vector<StampedPose> answers(const std::function<Pose(const Pose&)>& f, Nanoseconds late = 0) {
  static const TrialWalk walk = trial_walk();
  std::vector<StampedPose> poses;
  for (const TrialStep& step : walk.steps) poses.push_back({step.scan.stamp, f(trial_pose(step.scan.stamp - late))});
  return poses;
}

TEST(Conformance, NamesWhatThePosesAreOf) {
  const Pose X_RL = trial_walk().calibration.X_RL, X_W0 = trial_pose(0);
  const auto robot = [&](const Pose& X_WR) { return X_W0.inverse() * X_WR; };
  const auto lidar = [&](const Pose& X_WR) { return (X_W0 * X_RL).inverse() * X_WR * X_RL; };
  const auto words = [&](const std::vector<StampedPose>& poses, bool aligned = true) {
    const std::optional<Finding> found = misunderstanding(poses, X_RL, aligned);
    return found ? found->text : std::string();
  };
  const auto says = [&](const std::vector<StampedPose>& poses, const std::string& part, bool aligned = true) {
    EXPECT_NE(words(poses, aligned).find(part), std::string::npos) << words(poses, aligned);
  };
  EXPECT_EQ(words(answers(robot)), "");
  EXPECT_EQ(words(answers([](const Pose& X) { return X; }), false), "");
  says(answers(lidar), "the LiDAR in the frame of its first scan");
  says(answers([&](const Pose& X) { return X * X_RL; }, 0), "multiply them by the inverse of its mount", false);
  says(answers([&](const Pose& X) { return robot(X).inverse(); }), "the map in the robot");
  says(answers([&](const Pose& X) { return lidar(X).inverse(); }), "the map in the LiDAR");
  says(answers([&](const Pose& X) { return Pose{robot(X).q, 1000.0 * robot(X).t}; }), "millimetres");
  says(answers(robot, 50'000'000), "the middle of each scan");
  says(answers(lidar, 50'000'000), "LiDAR's poses in the middle");
  says(answers(robot, 100'000'000), "the scan before");
  says(answers([](const Pose&) { return Pose{}; }), "never changes");
  // Merely bad: nothing is claimed.
  EXPECT_EQ(words(answers([&](const Pose& X) {
              return robot(X) * Pose::from_xyz_yaw({X.t.y(), 1.0, X.t.x()}, 0.3);
            })),
            "");
}

TEST(TrialWalk, SeesTheRoomFromWhereItIs) {
  const TrialWalk walk = trial_walk();
  ASSERT_EQ(walk.steps.size(), 50U);
  for (const TrialStep& step : walk.steps) {
    ASSERT_EQ(step.scan.size(), static_cast<std::size_t>(step.scan.rings * step.scan.columns));
    for (std::size_t i = 0; i < step.scan.size(); i += 97) {
      const Pose X_WR = trial_pose(step.scan.stamp + step.scan.offset_ns[i]);
      const Eigen::Vector3d p_W = X_WR * walk.calibration.X_RL * step.scan.point_L[i];
      constexpr double six_sigma = 0.06;
      EXPECT_GT(step.scan.range_m[i], 0.0);
      EXPECT_GT(p_W.minCoeff(), -six_sigma);
      EXPECT_LT((p_W - Eigen::Vector3d(10, 8, 3)).maxCoeff(), six_sigma);
    }
    EXPECT_EQ(step.odometry.back().stamp, step.scan.stamp);
    EXPECT_EQ(step.imu.back().stamp, step.scan.stamp);
  }
}

}  // namespace
}  // namespace plumbline::slam
