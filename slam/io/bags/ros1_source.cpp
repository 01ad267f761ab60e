// SPDX-License-Identifier: Apache-2.0
// Apart, for what it includes takes long to compile.
#include "slam/io/bags/ros1_source.h"

#include <console_bridge/console.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include <map>
#include <optional>

#include "bim/errors.h"
#include "slam/io/bags/bag_check.h"
#include "slam/io/bags/ros1_unindexed.h"

namespace plumbline::slam {

namespace {

/// Known where the definition is the one that we read, or the type is none that we do.
Encoding encoding_of_type(const std::string& type, std::string_view md5) {
  namespace traits = ::ros::message_traits;
  static const std::map<std::string, std::string> known = {
      {traits::DataType<sensor_msgs::PointCloud2>::value(), traits::MD5Sum<sensor_msgs::PointCloud2>::value()},
      {traits::DataType<nav_msgs::Odometry>::value(), traits::MD5Sum<nav_msgs::Odometry>::value()},
      {traits::DataType<sensor_msgs::Imu>::value(), traits::MD5Sum<sensor_msgs::Imu>::value()},
      {traits::DataType<tf2_msgs::TFMessage>::value(), traits::MD5Sum<tf2_msgs::TFMessage>::value()},
  };
  const auto found = known.find(type);
  return found == known.end() || found->second == md5 ? Encoding::ros1 : Encoding::unknown;
}

class Ros1Source final : public MessageSource {
 public:
  explicit Ros1Source(const std::string& path) : mark_{path, 0, 0} {
    guarded([&] {
      bag_.open(path, rosbag::bagmode::Read);
      rosbag::View all(bag_);
      for (const rosbag::ConnectionInfo* connection : all.getConnections()) {
        if (ids_.contains(connection->topic)) continue;
        ids_[connection->topic] = topics_.size();
        topics_.push_back(
            {connection->topic, connection->datatype, encoding_of_type(connection->datatype, connection->md5sum)});
      }
    });
  }

  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return topics_; }

  void select(const std::vector<std::string>& topics) override {
    guarded([&] {
      view_.emplace(bag_, rosbag::TopicQuery(topics));
      at_ = view_->begin();
    });
  }

  [[nodiscard]] Nanoseconds start() override {
    rosbag::View all(bag_);
    return static_cast<Nanoseconds>(all.getBeginTime().toNSec());
  }

  [[nodiscard]] bool next(RawMessage& message) override {
    bool found = false;
    guarded([&] {
      if (!view_ || at_ == view_->end()) return;
      message.topic = ids_.at(at_->getTopic());
      message.time = static_cast<Nanoseconds>(at_->getTime().toNSec());
      message.bytes.resize(at_->size());
      ::ros::serialization::OStream stream(message.bytes.data(), static_cast<std::uint32_t>(message.bytes.size()));
      at_->write(stream);
      ++at_;
      found = true;
    });
    return found;
  }

 private:
  /// What the library throws on a bag that is damaged, with the bag's name.
  template <class F>
  void guarded(const F& function) const {
    try {
      function();
    } catch (const InputError&) {
      throw;
    } catch (const std::exception& error) {
      throw InputError(mark_, std::string("not a valid ROS 1 bag: ") + error.what());
    }
  }

  Mark mark_;
  rosbag::Bag bag_;
  std::vector<BagTopic> topics_;
  std::map<std::string, std::size_t> ids_;
  std::optional<rosbag::View> view_;
  rosbag::View::iterator at_;
};

}  // namespace

std::unique_ptr<MessageSource> open_ros1_bag(const std::string& path) {
  console_bridge::noOutputHandler();  // the library prints what it also throws
  try {
    if (!check_bag(path)) return open_unindexed_bag(path, encoding_of_type, true);
  } catch (const NoIndex&) {
    return open_unindexed_bag(path, encoding_of_type);
  } catch (const InputError&) {
    try {
      return open_unindexed_bag(path, encoding_of_type);
    } catch (const InputError&) {  // the first complaint says more
    }
    throw;
  }
  return std::make_unique<Ros1Source>(path);
}

}  // namespace plumbline::slam
