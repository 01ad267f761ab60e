// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/numbered_messages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "slam/io/bags/bag.h"
#include "slam/io/bags/message_sink.h"
#include "tests/folder.h"
#include "tests/input_error.h"
#include "tests/slam/io/bags/bag_of_four_scans.h"

namespace plumbline::slam {
namespace {

/// Messages of one topic, recorded at these times.
class OneTopic final : public MessageSource {
 public:
  explicit OneTopic(std::vector<Nanoseconds> times) : times_(std::move(times)) {}
  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return topics_; }
  void select(const std::vector<std::string>&) override { next_ = 0; }
  [[nodiscard]] bool next(RawMessage& message) override {
    if (next_ == times_.size()) return false;
    message = {0, times_[next_++], {1}};
    return true;
  }
  [[nodiscard]] Nanoseconds start() override { return times_.front(); }

 private:
  std::vector<Nanoseconds> times_;
  std::size_t next_ = 0;
  std::vector<BagTopic> topics_ = {{"/odom", "nav_msgs/Odometry", Encoding::cdr}};
};

constexpr Nanoseconds bound = 4'000'000'000'000'000'000;

TEST(NumberedMessagesTest, AMessageOfNoPossibleTimeIsLeftOut) {
  OneTopic source({std::numeric_limits<Nanoseconds>::min(), -bound, 1 - bound, 0, 1, bound - 1, bound});
  NumberedMessages messages(source);
  for (int round = 0; round < 2; ++round) {
    messages.select({"/odom"});
    std::vector<Nanoseconds> times;
    for (RawMessage message; messages.next(message);) times.push_back(message.time);
    EXPECT_EQ(times, (std::vector<Nanoseconds>{1 - bound, 0, 1, bound - 1}));
    EXPECT_EQ(
        messages.left_out(),
        std::vector<std::string>{"/odom: 3 of 7 messages were recorded more than 126 years from 1970 and left out"});
  }
  messages.select({"/odom"});
  int all = 0;
  for (RawMessage message; messages.next_of_any_time(message);) ++all;
  EXPECT_EQ(all, 7);
  EXPECT_TRUE(messages.left_out().empty());
}

TEST(NumberedMessagesTest, AtMostHalfAreLeftOut) {
  OneTopic source({0, bound, std::numeric_limits<Nanoseconds>::max()});
  NumberedMessages messages(source);
  messages.select({"/odom"});
  RawMessage message;
  EXPECT_TRUE(messages.next(message));
  EXPECT_EQ(input_error([&] { static_cast<void>(messages.next(message)); }),
            "/odom: 2 of 3 messages were recorded more than 126 years from 1970; at most half are left out");
}

/// The walk of four scans, in which one message of each topic has a good stamp and was recorded at no possible time.
void write_untimed(MessageSink& sink) {
  constexpr Nanoseconds never = 4'294'967'295'000'000'000;  // the latest that ROS 1 can write
  constexpr std::size_t untimed = 1;
  const auto later = [](Nanoseconds stamp) { return stamp + 1; };  // ROS 1 has no time 0
  const Encoding encoding = sink.encoding();
  const ros::Transform mount{0, "base_link", "velodyne", Pose{}};
  sink.write("/tf_static", MessageType::transforms, never, ros::write_transforms({&mount, 1}, encoding), true);
  const std::vector<SensorFrame> walk = walk_of_four_scans();
  for (std::size_t i = 0; i < walk.size(); ++i) {
    const SensorFrame& frame = walk[i];
    for (const Odometry& record : frame.odometry) {
      const bool last = &record == &frame.odometry.back();
      const ros::OdometryMessage message{{record.stamp, "odom", "base_link", record.X_OR}};
      sink.write("/odom", MessageType::odometry, i == untimed && last ? never : later(record.stamp),
                 ros::write_odometry(message, encoding), false);
    }
    sink.write("/velodyne_points", MessageType::cloud, i == untimed ? never : later(frame.scan.stamp),
               ros::write_cloud(cloud_of(frame.scan, CloudLayout::organised), "velodyne", encoding), false);
  }
  sink.finish();
}

TEST(NumberedMessagesTest, ABagOfAnyKindIsReadWithoutThem) {
  const Folder folder;
  write_untimed(*make_ros1_sink(folder / "a.bag"));
  write_untimed(*make_mcap_sink(folder / "a.mcap", ""));
  write_untimed(*make_rosbag2_sink(folder / "a", "a"));
  const std::vector<SensorFrame> walk = walk_of_four_scans();
  std::size_t odometry = 0;
  for (const SensorFrame& frame : walk) odometry += frame.odometry.size();
  for (const char* name : {"a.bag", "a.mcap", "a"}) {
    const auto recording = open_bag(folder / name, {}, nullptr);
    std::vector<Nanoseconds> stamps;
    std::size_t read = 0;
    for (SensorFrame frame; recording->next(frame); read += frame.odometry.size()) stamps.push_back(frame.scan.stamp);
    EXPECT_EQ(stamps, (std::vector<Nanoseconds>{walk[0].scan.stamp, walk[2].scan.stamp, walk[3].scan.stamp})) << name;
    EXPECT_EQ(read + 1, odometry) << name;
    std::vector<std::string> said = recording->left_out();
    std::sort(said.begin(), said.end());
    ASSERT_EQ(said.size(), 2U) << name;
    EXPECT_EQ(said[0], "/odom: 1 of " + std::to_string(odometry) +
                           " messages were recorded more than 126 years from 1970 and left out");
    EXPECT_EQ(said[1], "/velodyne_points: 1 of 4 messages were recorded more than 126 years from 1970 and left out");
  }
}

}  // namespace
}  // namespace plumbline::slam
