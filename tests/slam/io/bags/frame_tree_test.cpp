// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/frame_tree.h"

#include <gtest/gtest.h>

#include <numbers>
#include <utility>

namespace plumbline::slam {
namespace {

/// A mast on the base, turned by 90 degrees to the left; an IMU on it, upside down.
FrameTree mast() {
  constexpr double right = 0.5 * std::numbers::pi;
  FrameTree frames;
  frames.add({0, "/base", "mast", Pose::from_xyz_yaw({1.0, 0.0, 0.0}, right)});
  frames.add({0, "mast", "/imu", {exp_so3({2.0 * right, 0.0, 0.0}), {0.0, 0.5, 0.0}}});
  frames.add({0, "base", "arm", Pose::from_xyz_yaw({0.7, 0.0, 0.0}, 0.0)});
  frames.add({0, "odd", "even", Pose{}});
  frames.add({0, "even", "odd", Pose{}});
  return frames;
}

const Imu measured{5, {1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};

TEST(FrameTree, FindsAFrameOverOthers) {
  const FrameTree frames = mast();
  const std::optional<Pose> X = frames.find("imu", "base");
  ASSERT_TRUE(X.has_value());
  EXPECT_LT((X->t - Eigen::Vector3d(0.5, 0.0, 0.0)).norm(), 1e-12);
  EXPECT_TRUE(frames.find("base", "/base").has_value());
  const std::optional<Pose> back = frames.find("base", "imu");
  ASSERT_TRUE(back.has_value());
  EXPECT_LT((*X * *back).t.norm(), 1e-12);
  const std::optional<Pose> beside = frames.find("arm", "imu");
  ASSERT_TRUE(beside.has_value());
  EXPECT_LT(((*X * *beside).t - Eigen::Vector3d(0.7, 0.0, 0.0)).norm(), 1e-12);
  EXPECT_FALSE(frames.find("nowhere", "base").has_value());
  EXPECT_FALSE(frames.find("odd", "base").has_value()) << "a ring";
}

TEST(FrameTree, AFrameMayHaveTwoParents) {
  for (const bool map_first : {true, false}) {
    FrameTree frames;
    const ros::Transform to_map{0, "map", "lidar", Pose::from_xyz_yaw({9.0, 0.0, 0.0}, 0.0)};
    if (map_first) frames.add(to_map);
    frames.add({0, "base_link", "lidar", Pose::from_xyz_yaw({1.0, 0.0, 0.0}, 0.0)});
    if (!map_first) frames.add(to_map);
    const std::optional<Pose> X = frames.find("lidar", "base_link");
    ASSERT_TRUE(X.has_value());
    EXPECT_EQ(X->t.x(), 1.0);
    EXPECT_EQ(robot_above("lidar", frames), "base_link");
  }
}

TEST(FrameTree, SaysWhichJointsHaveSeveralValues) {
  FrameTree frames;
  const auto joint = [](double x) {
    return ros::Transform{0, "/base", "lidar", Pose::from_xyz_yaw({x, 0.0, 0.0}, 0.0)};
  };
  frames.add(joint(0.2));
  frames.add(joint(0.2));
  frames.add({0, "map", "lidar", Pose::from_xyz_yaw({9.0, 0.0, 0.0}, 0.0)});
  EXPECT_TRUE(frames.left_out("/tf_static").empty());
  frames.add(joint(0.5));
  const std::vector<std::string> said = frames.left_out("/tf_static");
  ASSERT_EQ(said.size(), 1U);
  EXPECT_EQ(
      said[0],
      "/tf_static: 'lidar' lies in 'base' with several values, first at (0.2, 0, 0) m with yaw 0, pitch 0, roll 0 "
      "deg, last at (0.5, 0, 0) m with yaw 0, pitch 0, roll 0 deg; the last one is taken");
  const std::optional<Pose> X = frames.find("lidar", "base");
  ASSERT_TRUE(X.has_value());
  EXPECT_EQ(X->t.x(), 0.5);
}

TEST(FrameTree, TurnsAnImuIntoTheRobot) {
  const std::optional<Imu> imu = in_robot({"/imu", measured}, mast(), "base");
  ASSERT_TRUE(imu.has_value());
  EXPECT_EQ(imu->stamp, 5);
  // Upside down (x, -y, -z), and from there (y, x, -z).
  EXPECT_LT((imu->angular_velocity_R - Eigen::Vector3d(2.0, 1.0, -3.0)).norm(), 1e-12);
  EXPECT_LT((imu->linear_acceleration_R - Eigen::Vector3d(5.0, 4.0, -6.0)).norm(), 1e-12);
}

TEST(FrameTree, LeavesAnImuOfTheRobotItself) {
  for (const auto& [frame, base] :
       {std::pair("base", "base"), std::pair("/base", "base"), std::pair("", "base"), std::pair("somewhere", "")}) {
    const std::optional<Imu> imu = in_robot({frame, measured}, mast(), base);
    ASSERT_TRUE(imu.has_value()) << frame;
    EXPECT_EQ(imu->angular_velocity_R, measured.angular_velocity_R);
    EXPECT_EQ(imu->linear_acceleration_R, measured.linear_acceleration_R);
  }
  EXPECT_FALSE(in_robot({"somewhere", measured}, mast(), "base").has_value());
}

TEST(FrameTree, HasTheNameFromTheMessage) {
  const ros::FramedImu said = ros::read_imu(ros::write_imu(measured, "/imu_link"));
  EXPECT_EQ(said.frame, "/imu_link");
  EXPECT_EQ(said.imu.stamp, measured.stamp);
  EXPECT_EQ(said.imu.angular_velocity_R, measured.angular_velocity_R);
  EXPECT_EQ(said.imu.linear_acceleration_R, measured.linear_acceleration_R);
}

}  // namespace
}  // namespace plumbline::slam
