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

namespace plumbline::slam {

namespace {

/// The checksum of the definition that we read, of a type that we read.
std::optional<std::string> known_md5(const std::string& type) {
  namespace traits = ::ros::message_traits;
  static const std::map<std::string, std::string> known = {
      {traits::DataType<sensor_msgs::PointCloud2>::value(), traits::MD5Sum<sensor_msgs::PointCloud2>::value()},
      {traits::DataType<nav_msgs::Odometry>::value(), traits::MD5Sum<nav_msgs::Odometry>::value()},
      {traits::DataType<sensor_msgs::Imu>::value(), traits::MD5Sum<sensor_msgs::Imu>::value()},
      {traits::DataType<tf2_msgs::TFMessage>::value(), traits::MD5Sum<tf2_msgs::TFMessage>::value()},
  };
  const auto found = known.find(type);
  return found == known.end() ? std::nullopt : std::optional(found->second);
}

class Ros1Source final : public MessageSource {
 public:
  explicit Ros1Source(const std::string& path) : mark_{path, 0, 0} {
    guarded([&] {
      check_bag(path);
      bag_.open(path, rosbag::bagmode::Read);
      rosbag::View all(bag_);
      for (const rosbag::ConnectionInfo* connection : all.getConnections()) {
        if (ids_.contains(connection->topic)) continue;
        const std::optional<std::string> md5 = known_md5(connection->datatype);
        const bool known = !md5 || *md5 == connection->md5sum;
        ids_[connection->topic] = topics_.size();
        topics_.push_back({connection->topic, connection->datatype, known ? Encoding::ros1 : Encoding::unknown});
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
    } catch (const rosbag::BagUnindexedException&) {
      throw InputError(mark_, "a bag that was not closed or is cut off; rosbag reindex may save it");
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
  return std::make_unique<Ros1Source>(path);
}

}  // namespace plumbline::slam
