// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "bim/errors.h"
#include "slam/io/bags/ros_message.h"
#include "tests/input_error.h"

namespace plumbline::slam {
namespace {

// Lengths that a program of ROS 2 gave for the same messages.
TEST(Cdr, MessagesHaveTheLengthsOfRos2) {
  EXPECT_EQ(ros::write_clock(5, Encoding::cdr).size(), 12U);
  EXPECT_EQ(ros::write_imu({}, "base_link", Encoding::cdr).size(), 324U);
  ros::OdometryMessage odometry;
  odometry.X_OR.parent = "odom";
  odometry.X_OR.child = "base_link";
  EXPECT_EQ(ros::write_odometry(odometry, Encoding::cdr).size(), 724U);
  PointCloud cloud;
  cloud.width = 3;
  cloud.height = 1;
  cloud.point_step = 22;
  cloud.row_step = 66;
  cloud.data.resize(66);
  for (const char* name : {"x", "y", "z", "intensity", "ring", "time"})
    cloud.fields.push_back({name, 0, PointType::f32});
  EXPECT_EQ(ros::write_cloud(cloud, "velodyne", Encoding::cdr).size(), 259U);
}

TEST(Cdr, EveryCutMessageIsRefused) {
  const ros::Transform transform{7, "base_link", "velodyne", Pose::from_xyz_yaw({1, 2, 3}, 0.5)};
  const ros::Bytes whole = ros::write_transforms({&transform, 1}, Encoding::cdr);
  EXPECT_EQ(ros::read_transforms(whole, Encoding::cdr).all[0].X.t, transform.X.t);
  EXPECT_EQ(ros::read_transforms(whole, Encoding::cdr).all[0].child, "velodyne");
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THROW((void)ros::read_transforms(std::span(whole).first(size), Encoding::cdr), InputError) << size;
  ros::Bytes big_endian = whole;
  big_endian[1] = 0;
  EXPECT_NE(input_error([&] { (void)ros::read_transforms(big_endian, Encoding::cdr); }).find("little-endian CDR"),
            std::string::npos);
}

// builtin_interfaces/Time has int32 seconds, std_msgs of ROS 1 has uint32.
TEST(Cdr, SecondsMayBeBefore1970) {
  for (const Encoding encoding : {Encoding::ros1, Encoding::cdr}) {
    Imu imu;
    imu.stamp = 5'000'000'007;
    ros::Bytes bytes = ros::write_imu(imu, "base_link", encoding);
    const std::int32_t seconds = -5;  // after the number of the header in ROS 1, and the head in ROS 2
    std::memcpy(&bytes[4], &seconds, sizeof seconds);
    const Nanoseconds stamp = ros::read_imu(bytes, encoding).imu.stamp;
    EXPECT_EQ(stamp, encoding == Encoding::cdr ? -4'999'999'993 : 4'294'967'291'000'000'007);
  }
}

TEST(Cdr, PosesAreReadOfEveryTypeThatHoldsThem) {
  for (const Encoding encoding : {Encoding::ros1, Encoding::cdr}) {
    ros::OdometryMessage odometry;
    odometry.X_OR = {7, "odom", "base_link", Pose::from_xyz_yaw({1, 2, 3}, 0.5)};
    const auto poses = ros::read_poses("nav_msgs/Odometry", ros::write_odometry(odometry, encoding), encoding);
    ASSERT_EQ(poses.size(), 1U);
    EXPECT_EQ(poses[0].stamp, 7);
    EXPECT_EQ(poses[0].X_FR.t, odometry.X_OR.X.t);
  }
  std::vector<std::uint8_t> one = {0, 1, 0, 0}, path = one;
  const auto put = [](std::vector<std::uint8_t>& m, auto value) {
    m.resize(4 + (m.size() - 4 + sizeof value - 1) / sizeof value * sizeof value);
    m.resize(m.size() + sizeof value);
    std::memcpy(&m[m.size() - sizeof value], &value, sizeof value);
  };
  const auto put_header = [&](std::vector<std::uint8_t>& m, std::int32_t s) {
    put(m, s);
    put(m, std::uint32_t{5});
    put(m, std::uint32_t{4});
    for (const char c : {'m', 'a', 'p', '\0'}) put(m, c);
  };
  const auto put_pose = [&](std::vector<std::uint8_t>& m, double x) {
    for (const double v : {x, 2.0, 3.0, 0.0, 0.0, 0.6, 0.8}) put(m, v);
  };
  put_header(one, 1);
  put_pose(one, 1.0);
  put_header(path, 9);
  put(path, std::uint32_t{3});
  for (const int i : {1, 2, 3}) {
    put_header(path, i);
    put_pose(path, i);
  }
  const auto single = ros::read_poses("geometry_msgs/PoseStamped", one, Encoding::cdr);
  const auto many = ros::read_poses("nav_msgs/Path", path, Encoding::cdr);
  ASSERT_EQ(single.size(), 1U);
  ASSERT_EQ(many.size(), 3U);
  for (const StampedPose& pose : {single[0], many[0]}) {
    EXPECT_EQ(pose.stamp, 1'000'000'005);
    EXPECT_EQ(pose.X_FR.t, Eigen::Vector3d(1.0, 2.0, 3.0));
    EXPECT_NEAR(pose.X_FR.q.z(), 0.6, 1e-12);
    EXPECT_NEAR(pose.X_FR.q.w(), 0.8, 1e-12);
  }
  EXPECT_EQ(many[2].stamp, 3'000'000'005);
  EXPECT_THROW((void)ros::read_poses("nav_msgs/Path", std::span(path).first(path.size() - 1), Encoding::cdr),
               InputError);
  EXPECT_FALSE(ros::holds_poses("sensor_msgs/Imu"));
}

TEST(Cdr, LivoxMessagesAreClouds) {
  std::vector<std::uint8_t> m = {0, 1, 0, 0};
  const auto put = [&](auto value) {
    m.resize(4 + (m.size() - 4 + sizeof value - 1) / sizeof value * sizeof value);
    m.resize(m.size() + sizeof value);
    std::memcpy(&m[m.size() - sizeof value], &value, sizeof value);
  };
  put(std::int32_t{1});
  put(std::uint32_t{0});
  put(std::uint32_t{12});
  for (const char c : "livox_frame") put(c);
  put(std::uint64_t{2'000'000'000});
  constexpr std::uint32_t points = 100;
  put(points);
  for (int i = 0; i < 4; ++i) put(std::uint8_t{0});
  put(points);
  for (std::uint32_t i = 0; i < points; ++i) {
    put(400'000 * (i + 1));
    for (const float value : {3.0F, 0.0F, 0.013F * static_cast<float>(i)}) put(value);
    for (const int value : {200, 0, 1}) put(static_cast<std::uint8_t>(value));
  }
  const ros::FramedCloud cloud = ros::read_livox(m, Encoding::cdr);
  EXPECT_EQ(cloud.frame, "livox_frame");
  const Scan scan = scan_of(cloud.cloud);
  EXPECT_EQ(scan.rings, 1);
  EXPECT_EQ(scan.stamp, 2'040'000'000);
  ASSERT_EQ(scan.size(), points);
  EXPECT_EQ(scan.offset_ns[0], -39'600'000);
  EXPECT_EQ(scan.point_L[99], Eigen::Vector3d(3.0, 0.0, static_cast<double>(0.013F * 99.0F)));
  EXPECT_EQ(scan.reflectivity[1], 200.0F);
  for (const std::uint64_t base :
       {std::uint64_t{0}, std::uint64_t{90'000'000'000}, std::uint64_t{4'000'000'000'000'000'000},
        ~std::uint64_t{0} / 2, ~std::uint64_t{0}}) {
    std::vector<std::uint8_t> other_clock = m;
    std::memcpy(&other_clock[4 + 8 + 4 + 12], &base, sizeof base);
    EXPECT_EQ(ros::read_livox(other_clock, Encoding::cdr).cloud.stamp, 1'000'000'000) << base << ", of the header";
  }
  // Two more points than said before.
  const std::uint32_t other = points + 2;
  std::memcpy(&m[4 + 8 + 4 + 12 + 8], &other, sizeof other);
  EXPECT_THROW((void)ros::read_livox(m, Encoding::cdr), InputError);
}

}  // namespace
}  // namespace plumbline::slam
