// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/transform_odometry.h"

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "slam/io/bags/bag_topics.h"
#include "slam/io/bags/frame_tree.h"
#include "slam/io/bags/ros_message.h"

namespace plumbline::slam {

namespace {

constexpr std::string_view arrow = " -> ";

struct RobotJoint {
  std::string odom, base;
};

/// Whether one is the odometry's frame and the other the robot's, of one namespace.
bool is_robot_joint(const std::string& parent, const std::string& child) {
  const auto split = [](const std::string& frame) {
    const std::size_t slash = frame.rfind('/');
    return slash == std::string::npos ? std::pair(std::string(), frame)
                                      : std::pair(frame.substr(0, slash), frame.substr(slash + 1));
  };
  const auto [space_P, P] = split(parent);
  const auto [space_C, C] = split(child);
  return space_P == space_C && P == "odom" && (C == "base_link" || C == "base_footprint");
}

/// Nothing where a message holds numbers that cannot be.
std::optional<std::vector<ros::Transform>> transforms_of(const MessageSource& source, const RawMessage& message) {
  try {
    return ros::read_transforms(message.bytes, source.topics()[message.topic].encoding);
  } catch (const ros::ImpossibleNumber&) {
    return std::nullopt;
  }
}

/// The one joint of a robot that moves; nothing where there are several.
std::optional<RobotJoint> find_robot_joint(MessageSource& source, const std::string& topic) {
  struct Seen {
    ros::Transform first;
    bool moved = false, of_two_parents = false;
  };
  constexpr double still_m = 1e-9, still_rad = 1e-9;
  std::map<std::string, Seen> children;
  source.select({topic});
  for (RawMessage message; source.next(message);)
    for (const ros::Transform& t : transforms_of(source, message).value_or(std::vector<ros::Transform>())) {
      const auto [place, is_new] = children.try_emplace(plain_frame(t.child), Seen{t});
      Seen& seen = place->second;
      const Pose& X = seen.first.X;
      seen.of_two_parents = seen.of_two_parents || plain_frame(t.parent) != plain_frame(seen.first.parent);
      seen.moved = seen.moved || (t.X.t - X.t).norm() > still_m || t.X.q.angularDistance(X.q) > still_rad;
    }
  std::vector<RobotJoint> found;
  for (const auto& [child, seen] : children) {
    const std::string parent = plain_frame(seen.first.parent);
    if (seen.moved && !seen.of_two_parents && is_robot_joint(parent, child)) found.push_back({parent, child});
  }
  return found.size() == 1 ? std::optional(found.front()) : std::nullopt;
}

class TransformOdometry final : public MessageSource {
 public:
  TransformOdometry(std::unique_ptr<MessageSource> source, std::string transforms, RobotJoint joint)
      : source_(std::move(source)),
        transforms_(std::move(transforms)),
        joint_(std::move(joint)),
        topics_(source_->topics()) {
    topics_.push_back(
        {transforms_ + ": " + joint_.odom + std::string(arrow) + joint_.base, "nav_msgs/Odometry", Encoding::cdr});
  }

  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return topics_; }

  void select(const std::vector<std::string>& topics) override {
    const auto is_wanted = [&](const std::string& name) {
      return std::find(topics.begin(), topics.end(), name) != topics.end();
    };
    odometry_wanted_ = is_wanted(topics_.back().name);
    transforms_wanted_ = is_wanted(transforms_);
    std::vector<std::string> all = topics;
    if (odometry_wanted_ && !transforms_wanted_) all.push_back(transforms_);
    waiting_.clear();
    impossible_ = 0;
    source_->select(all);
  }

  [[nodiscard]] bool next(RawMessage& message) override {
    while (waiting_.empty()) {
      if (!source_->next(message)) return false;
      const bool of_transforms = source_->topics()[message.topic].name == transforms_;
      if (of_transforms && odometry_wanted_) add_odometry(message);
      if (!of_transforms || transforms_wanted_) return true;
    }
    message = std::move(waiting_.front());
    waiting_.pop_front();
    return true;
  }

  [[nodiscard]] Nanoseconds start() override { return source_->start(); }

  [[nodiscard]] std::vector<std::string> left_out() const override {
    std::vector<std::string> all = source_->left_out();
    if (impossible_ > 0)
      all.push_back(transforms_ + ": " + std::to_string(impossible_) +
                    " messages left out: numbers that are not finite, or no rotation");
    return all;
  }

 private:
  void add_odometry(const RawMessage& message) {
    const auto transforms = transforms_of(*source_, message);
    impossible_ += transforms ? 0 : 1;
    if (!transforms) return;
    for (const ros::Transform& t : *transforms) {
      if (plain_frame(t.child) != joint_.base || plain_frame(t.parent) != joint_.odom) continue;
      ros::OdometryMessage odometry;
      odometry.X_OR = t;
      waiting_.push_back({topics_.size() - 1, message.time, ros::write_odometry(odometry, Encoding::cdr)});
    }
  }

  std::unique_ptr<MessageSource> source_;
  std::string transforms_;
  RobotJoint joint_;
  std::vector<BagTopic> topics_;  ///< the last is the odometry
  bool odometry_wanted_ = false, transforms_wanted_ = false;
  std::deque<RawMessage> waiting_;  ///< odometry of a message that was read
  std::size_t impossible_ = 0;
};

}  // namespace

std::unique_ptr<MessageSource> with_odometry_of_transforms(std::unique_ptr<MessageSource> source) {
  const std::string transforms = moving_transforms(*source);
  if (transforms.empty() || holds_odometry(*source)) return source;
  std::optional<RobotJoint> joint = find_robot_joint(*source, transforms);
  if (!joint) return source;
  return std::make_unique<TransformOdometry>(std::move(source), transforms, std::move(*joint));
}

bool is_of_transforms(std::string_view topic) { return topic.find(arrow) != std::string_view::npos; }

}  // namespace plumbline::slam
