// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/transform_odometry.h"

#include <gtest/gtest.h>

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
      if (count++ == said.impossible) all.back().X.t.x() = std::numeric_limits<double>::quiet_NaN();
      sink->write("/tf", MessageType::transforms, record.stamp, ros::write_transforms(all, Encoding::cdr), false);
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

TEST(TransformOdometry, OdometryOfATopicIsPreferred) {
  const Folder folder;
  Alteration walk;
  walk.transforms = "/tf";
  write_altered(folder / "walk", walk);
  EXPECT_EQ(read_walk(folder / "walk").topic, "/odom");
}

TEST(TransformOdometry, LeavesOutWhatIsNoPose) {
  const std::size_t all = read_walk(Transforms{}).odometry.size();
  Transforms said;
  said.impossible = 7;
  const Walk walk = read_walk(said);
  EXPECT_EQ(walk.odometry.size(), all - 1);
  ASSERT_EQ(walk.left_out.size(), 1U);
  EXPECT_EQ(walk.left_out[0], "/tf: 1 messages left out: numbers that are not finite, or no rotation");
}

}  // namespace
}  // namespace plumbline::slam
