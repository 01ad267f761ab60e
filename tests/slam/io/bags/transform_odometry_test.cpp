// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/transform_odometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "bim/errors.h"
#include "slam/io/bags/bag.h"
#include "slam/io/bags/message_sink.h"
#include "tests/folder.h"
#include "tests/slam/io/bags/altered_walk.h"
#include "tests/slam/io/bags/bag_of_four_scans.h"

namespace plumbline::slam {
namespace {

struct Transforms {
  std::string parent = "odom", child = "base_link";
  std::vector<ros::Transform> others;  ///< in every message
  std::string mount_on = "base_link";  ///< parent of the LiDAR's frame on /tf_static; empty: none
  bool stands_still = false;
  int impossible = -1;  ///< message that holds no number
  int untimed = -1;     ///< message that was recorded at no possible time
};

void write_transforms_alone(const std::string& path, const Transforms& said) {
  const auto sink = make_rosbag2_sink(path, "walk");
  const ros::Transform mount{0, said.mount_on, "velodyne", Pose{}};
  if (!said.mount_on.empty())
    sink->write("/tf_static", MessageType::transforms, 0, ros::write_transforms({&mount, 1}, Encoding::cdr), true);
  int count = 0;
  for (const SensorFrame& frame : walk_of_four_scans()) {
    for (const Odometry& record : frame.odometry) {
      std::vector<ros::Transform> all = said.others;
      for (ros::Transform& other : all) other.X.t.x() = seconds(record.stamp);
      all.push_back({record.stamp, said.parent, said.child, said.stands_still ? Pose{} : record.X_OR});
      const Nanoseconds time = count == said.untimed ? std::numeric_limits<Nanoseconds>::max() : record.stamp;
      if (count++ == said.impossible) all.back().X.t.x() = std::numeric_limits<double>::quiet_NaN();
      sink->write("/tf", MessageType::transforms, time, ros::write_transforms(all, Encoding::cdr), false);
    }
    sink->write("/velodyne_points", MessageType::cloud, frame.scan.stamp,
                ros::write_cloud(cloud_of(frame.scan, CloudLayout::organised), "velodyne", Encoding::cdr), false);
  }
  sink->finish();
}

struct Walk {
  std::vector<Odometry> odometry;
  std::size_t scans = 0;
  std::string topic;
  std::vector<std::string> left_out;
};

Walk read_walk(const std::string& path) {
  const auto recording = open_bag(path, {}, nullptr);
  Walk walk;
  for (SensorFrame frame; recording->next(frame); ++walk.scans)
    walk.odometry.insert(walk.odometry.end(), frame.odometry.begin(), frame.odometry.end());
  walk.topic = recording->taken().odometry;
  walk.left_out = recording->left_out();
  return walk;
}

Walk read_walk(const Transforms& said) {
  const Folder folder;
  write_transforms_alone(folder / "walk", said);
  return read_walk(folder / "walk");
}

TEST(TransformOdometry, IsThatOfTheTopicOfOdometry) {
  const Folder folder;
  write_altered(folder / "plain", {});
  const Walk plain = read_walk(folder / "plain");
  for (const auto& [parent, child] :
       {std::pair("odom", "base_link"), std::pair("/odom", "/base_footprint"), std::pair("a1/odom", "a1/base_link")}) {
    Transforms said;
    said.parent = parent;
    said.child = said.mount_on = child;
    said.others = {{0, "base_link", "wheel", Pose{}}, {0, "map", "odom", Pose{}}};
    const Walk walk = read_walk(said);
    EXPECT_EQ(walk.scans, plain.scans);
    EXPECT_TRUE(walk.left_out.empty());
    EXPECT_NE(walk.topic.find(" -> "), std::string::npos) << walk.topic;
    ASSERT_EQ(walk.odometry.size(), plain.odometry.size());
    for (std::size_t i = 0; i < walk.odometry.size(); ++i) {
      EXPECT_EQ(walk.odometry[i].stamp, plain.odometry[i].stamp);
      EXPECT_TRUE(walk.odometry[i].X_OR.t == plain.odometry[i].X_OR.t);
      EXPECT_TRUE(walk.odometry[i].X_OR.q.coeffs() == plain.odometry[i].X_OR.q.coeffs());
    }
  }
}

TEST(TransformOdometry, IsNotGuessed) {
  std::vector<Transforms> all(6);
  all[0].child = "base";
  all[1].parent = "map";
  all[2].others = {{0, "b/odom", "b/base_link", Pose{}}};  // two robots
  all[3].others = {{0, "map", "base_link", Pose{}}};       // two parents
  all[4].stands_still = true;
  all[5].mount_on = "";
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Walk walk = read_walk(all[i]);
    EXPECT_EQ(walk.topic, "") << i;
    EXPECT_TRUE(walk.odometry.empty()) << i;
    EXPECT_EQ(walk.scans, 4U) << i;
    ASSERT_EQ(walk.left_out.size(), 1U) << i;
    EXPECT_NE(walk.left_out[0].find("no odometry"), std::string::npos) << walk.left_out[0];
  }
}

/// The robot's body over its footprint.
Pose body_at(Nanoseconds stamp) {
  const double phase = 2.0 * seconds(stamp);
  return {Eigen::Quaterniond(Eigen::AngleAxisd(0.02 * std::sin(phase), Eigen::Vector3d::UnitY())),
          {0.0, 0.01 * std::cos(phase), 0.3 + 0.01 * std::sin(phase)}};
}

/// The walk with its odometry as two joints. late: by how much the second's records are later; until: its last stamp.
void write_two_joints(const std::string& path, const std::string& mount_on, Nanoseconds late, Nanoseconds until) {
  const auto sink = make_rosbag2_sink(path, "walk");
  const ros::Transform mount{0, mount_on, "velodyne", Pose{}};
  sink->write("/tf_static", MessageType::transforms, 0, ros::write_transforms({&mount, 1}, Encoding::cdr), true);
  for (const SensorFrame& frame : walk_of_four_scans()) {
    for (const Odometry& record : frame.odometry) {
      const ros::Transform correction{record.stamp, "map", "odom",
                                      Pose::from_xyz_yaw({seconds(record.stamp), 0, 0}, 0)};
      const ros::Transform first{record.stamp, "odom", "base_footprint", record.X_OR * body_at(record.stamp).inverse()};
      const ros::Transform second{record.stamp + late, "base_footprint", "base_link", body_at(record.stamp + late)};
      for (const ros::Transform* t : {&correction, &first, &second})
        if (t != &second || t->stamp <= until)
          sink->write("/tf", MessageType::transforms, record.stamp, ros::write_transforms({t, 1}, Encoding::cdr),
                      false);
    }
    sink->write("/velodyne_points", MessageType::cloud, frame.scan.stamp,
                ros::write_cloud(cloud_of(frame.scan, CloudLayout::organised), "velodyne", Encoding::cdr), false);
  }
  sink->finish();
}

TEST(TransformOdometry, TwoJointsThatMoveAreOne) {
  constexpr Nanoseconds always = std::numeric_limits<Nanoseconds>::max();
  const Folder folder;
  write_altered(folder / "plain", {});
  const Walk plain = read_walk(folder / "plain");
  int trial = 0;
  for (const Nanoseconds late : {0, 1'700'000}) {
    const std::string path = folder / ("walk" + std::to_string(trial++));
    write_two_joints(path, "base_link", late, always);
    const Walk walk = read_walk(path);
    EXPECT_EQ(walk.topic, "/tf: odom -> base_footprint -> base_link");
    EXPECT_GE(walk.scans + (late == 0 ? 0 : 1), plain.scans);
    ASSERT_GE(walk.odometry.size() + 4, plain.odometry.size());
    const auto true_pose = [&](Nanoseconds stamp) {
      const auto same = std::find_if(plain.odometry.begin(), plain.odometry.end(),
                                     [&](const Odometry& other) { return other.stamp == stamp; });
      EXPECT_NE(same, plain.odometry.end());
      return same->X_OR;
    };
    const Odometry& start = walk.odometry.front();
    for (const Odometry& record : walk.odometry) {
      const Pose error =
          (true_pose(start.stamp).inverse() * true_pose(record.stamp)).inverse() * (start.X_OR.inverse() * record.X_OR);
      EXPECT_LT(error.t.norm(), late == 0 ? 1e-9 : 3e-4);
      EXPECT_LT(error.q.angularDistance(Eigen::Quaterniond::Identity()), late == 0 ? 1e-7 : 3e-4);
    }
  }
}

TEST(TransformOdometry, TheFirstJointIsEnoughWhereTheLidarIsOnIt) {
  const Folder folder;
  write_two_joints(folder / "walk", "base_footprint", 0, std::numeric_limits<Nanoseconds>::max());
  EXPECT_EQ(read_walk(folder / "walk").topic, "/tf: odom -> base_footprint");
}

TEST(TransformOdometry, RecordsWithoutTheSecondJointAreLeftOut) {
  const Folder folder;
  const std::vector<SensorFrame> frames = walk_of_four_scans();
  write_two_joints(folder / "walk", "base_link", 0, frames[1].odometry.back().stamp);
  const Walk walk = read_walk(folder / "walk");
  ASSERT_EQ(walk.left_out.size(), 1U);
  EXPECT_NE(walk.left_out[0].find(" records of odom -> base_footprint left out: no base_footprint -> base_link at "),
            std::string::npos)
      << walk.left_out[0];
}

TEST(TransformOdometry, OdometryOfATopicIsPreferred) {
  const Folder folder;
  Alteration walk;
  walk.transforms = "/tf";
  write_altered(folder / "walk", walk);
  EXPECT_EQ(read_walk(folder / "walk").topic, "/odom");
}

/// Of all transforms one is left out, which is said.
void expect_one_left_out(const Transforms& transforms, const std::string& said) {
  const Walk walk = read_walk(transforms);
  EXPECT_EQ(walk.odometry.size(), read_walk(Transforms{}).odometry.size() - 1);
  EXPECT_EQ(walk.left_out, std::vector<std::string>{said});
}

TEST(TransformOdometry, LeavesOutWhatIsNoPose) {
  Transforms one;
  one.impossible = 7;
  expect_one_left_out(one, "/tf: 1 transforms left out: numbers that are not finite, or no rotation");
}

TEST(TransformOdometry, LeavesOutWhatWasRecordedAtNoPossibleTime) {
  Transforms one;
  one.untimed = 7;
  expect_one_left_out(one, "/tf: 1 of " + std::to_string(read_walk(Transforms{}).odometry.size()) +
                               " messages were recorded more than 126 years from 1970 and left out");
}

}  // namespace
}  // namespace plumbline::slam
