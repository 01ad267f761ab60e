// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/bag_topics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "slam/io/bags/bag.h"
#include "slam/io/bags/ros_message.h"
#include "tests/slam/io/packets/made_cloud.h"

namespace plumbline::slam {
namespace {

/// Clouds of several topics in turn, and odometry.
class Clouds final : public MessageSource {
 public:
  /// Each a name and the frame of its clouds.
  Clouds(const std::vector<std::pair<std::string, std::string>>& clouds, const std::string& odometry_parent) {
    constexpr int each = 50;
    const PointCloud cloud = cloud_with({"x", "y", "z"}, {{1, 2, 3}});
    for (const auto& [name, frame] : clouds) topics_.push_back({name, "sensor_msgs/PointCloud2", Encoding::ros1});
    topics_.push_back({"/odom", "nav_msgs/Odometry", Encoding::ros1});
    OdometryMessage odometry;
    odometry.X_OR.parent = odometry_parent;
    odometry.X_OR.child = "base_link";
    for (int i = 0; i < each; ++i) {
      for (std::size_t k = 0; k < clouds.size(); ++k) messages_.push_back({k, i, bytes(cloud, clouds[k].second)});
      messages_.push_back({clouds.size(), i, as_vector(ros::write_odometry(odometry))});
    }
  }

  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return topics_; }
  void select(const std::vector<std::string>& topics) override {
    selected_ = topics;
    at_ = 0;
  }
  [[nodiscard]] bool next(RawMessage& message) override {
    for (; at_ < messages_.size(); ++at_) {
      const std::string& name = topics_[messages_[at_].topic].name;
      if (std::find(selected_.begin(), selected_.end(), name) == selected_.end()) continue;
      message = messages_[at_++];
      return true;
    }
    return false;
  }
  [[nodiscard]] Nanoseconds start() override { return 0; }

 private:
  using OdometryMessage = ros::OdometryMessage;
  template <class Bytes>
  static std::vector<std::uint8_t> as_vector(const Bytes& bytes) {
    return {bytes.begin(), bytes.end()};
  }
  static std::vector<std::uint8_t> bytes(const PointCloud& cloud, const std::string& frame) {
    return as_vector(ros::write_cloud(cloud, frame));
  }

  std::vector<BagTopic> topics_;
  std::vector<RawMessage> messages_;
  std::vector<std::string> selected_;
  std::size_t at_ = 0;
};

std::string chosen(const std::vector<std::pair<std::string, std::string>>& clouds, const std::string& odometry_parent) {
  Clouds source(clouds, odometry_parent);
  return choose_topics(source, {}, {"b.bag", 0, 0}).points;
}

TEST(BagTopics, CloudsInAMapsFrameAreNoScansBesideOthers) {
  EXPECT_EQ(chosen({{"/cloud_registered", "camera_init"}, {"/velodyne_points", "velodyne"}}, "odom"),
            "/velodyne_points");
  EXPECT_EQ(chosen({{"/aligned", "/start"}, {"/points", "lidar"}}, "start"), "/points") << "where odometry's poses are";
  EXPECT_EQ(chosen({{"/front", "front"}, {"/rear", "rear"}}, "odom"), "/front");
  EXPECT_EQ(chosen({{"/cloud_registered", "map"}}, "odom"), "/cloud_registered") << "there is no other";
  EXPECT_EQ(chosen({{"/a", "map"}, {"/b", "odom"}}, "odom"), "/a");
}

}  // namespace
}  // namespace plumbline::slam
