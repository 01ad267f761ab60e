// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/transform_odometry.h"

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "slam/io/bags/bag_topics.h"
#include "slam/io/bags/frame_tree.h"
#include "slam/io/bags/ros_message.h"

namespace plumbline::slam {

namespace {

constexpr std::string_view arrow = " -> ";

/// From the odometry's frame to the robot's, of one joint, or of two with a frame between them.
struct RobotJoint {
  std::string odom, base;
  std::string between;  ///< may be empty

  [[nodiscard]] std::string name() const {
    return odom + std::string(arrow) + (between.empty() ? "" : between + std::string(arrow)) + base;
  }
};

/// The last part of a frame's name, and the namespace before it.
std::pair<std::string, std::string> split_frame(const std::string& frame) {
  const std::size_t slash = frame.rfind('/');
  return slash == std::string::npos ? std::pair(std::string(), frame)
                                    : std::pair(frame.substr(0, slash), frame.substr(slash + 1));
}

/// Whether one is the odometry's frame and the other the robot's, of one namespace.
bool is_robot_joint(const std::string& parent, const std::string& child) {
  const auto [space_P, P] = split_frame(parent);
  const auto [space_C, C] = split_frame(child);
  return space_P == space_C && P == "odom" && (C == "base_link" || C == "base_footprint");
}

ros::Transforms transforms_of(const MessageSource& source, const RawMessage& message) {
  return ros::read_transforms(message.bytes, source.topics()[message.topic].encoding);
}

/// Whether a second joint lifts and tilts the robot over its footprint, as those of legged robots do.
bool is_second_joint(const std::string& parent, const std::string& child) {
  const auto [space_P, P] = split_frame(parent);
  const auto [space_C, C] = split_frame(child);
  return space_P == space_C && P == "base_footprint" && C == "base_link";
}

/// A child on /tf.
struct SeenJoint {
  ros::Transform first;
  bool moved = false, of_two_parents = false;

  [[nodiscard]] std::string parent() const { return plain_frame(first.parent); }
};
using SeenJoints = std::map<std::string, SeenJoint>;

SeenJoints see_joints(MessageSource& source, const std::string& topic) {
  constexpr double still_m = 1e-9, still_rad = 1e-9;
  SeenJoints children;
  source.select({topic});
  for (RawMessage message; source.next(message);)
    for (const ros::Transform& t : transforms_of(source, message).all) {
      const auto [place, is_new] = children.try_emplace(plain_frame(t.child), SeenJoint{t});
      SeenJoint& seen = place->second;
      const Pose& X = seen.first.X;
      seen.of_two_parents = seen.of_two_parents || plain_frame(t.parent) != seen.parent();
      seen.moved = seen.moved || (t.X.t - X.t).norm() > still_m || t.X.q.angularDistance(X.q) > still_rad;
    }
  return children;
}

/// Frames to which others are fixed, on /tf_static or by joints that do not move.
std::set<std::string> frames_with_mounts(MessageSource& source, const SeenJoints& joints) {
  std::set<std::string> parents;
  for (const auto& [child, joint] : joints)
    if (!joint.moved) parents.insert(joint.parent());
  std::vector<std::string> fixed;
  for (const BagTopic& topic : source.topics())
    if (is_transforms(topic.type) && topic.name.ends_with("/tf_static")) fixed.push_back(topic.name);
  source.select(fixed);
  for (RawMessage message; source.next(message);)
    for (const ros::Transform& t : transforms_of(source, message).all) parents.insert(plain_frame(t.parent));
  return parents;
}

/// The one joint of a robot that moves, with a second one behind it if that moves, too, and the sensors are fixed to
/// its end; nothing where there are several.
std::optional<RobotJoint> find_robot_joint(MessageSource& source, const std::string& topic) {
  const SeenJoints joints = see_joints(source, topic);
  std::vector<RobotJoint> found, second;
  for (const auto& [child, joint] : joints) {
    if (!joint.moved || joint.of_two_parents) continue;
    if (is_robot_joint(joint.parent(), child)) found.push_back({joint.parent(), child, {}});
    if (is_second_joint(joint.parent(), child)) second.push_back({joint.parent(), child, {}});
  }
  if (found.size() != 1) return std::nullopt;
  const RobotJoint& first = found.front();
  const auto next =
      std::find_if(second.begin(), second.end(), [&](const RobotJoint& joint) { return joint.odom == first.base; });
  if (next == second.end()) return first;
  const std::set<std::string> with_mounts = frames_with_mounts(source, joints);
  const bool ends_there = with_mounts.contains(first.base) && !with_mounts.contains(next->base);
  return ends_there ? first : RobotJoint{first.odom, next->base, first.base};
}

class TransformOdometry final : public MessageSource {
 public:
  TransformOdometry(std::unique_ptr<MessageSource> source, std::string transforms, RobotJoint joint)
      : source_(std::move(source)),
        transforms_(std::move(transforms)),
        joint_(std::move(joint)),
        topics_(source_->topics()) {
    topics_.push_back({transforms_ + ": " + joint_.name(), "nav_msgs/Odometry", Encoding::cdr});
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
    firsts_.clear();
    seconds_.clear();
    impossible_ = unjoined_ = read_ = untimed_ = 0;
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
    if (impossible_ > 0) all.push_back(ros::impossible_transforms(transforms_, impossible_));
    if (untimed_ > 0) all.push_back(transforms_ + ": " + untimed_messages(untimed_, read_) + " and left out");
    constexpr std::size_t at_the_end = 10;  // that the second joint's last record was too early for is usual
    const std::size_t unjoined = unjoined_ + (firsts_.size() > at_the_end ? firsts_.size() : 0);
    if (unjoined > 0)
      all.push_back(transforms_ + ": " + std::to_string(unjoined) + " records of " + joint_.odom + std::string(arrow) +
                    joint_.between + " left out: no " + joint_.between + std::string(arrow) + joint_.base +
                    " at their time");
    return all;
  }

 private:
  void add_odometry(const RawMessage& message) {
    ++read_;
    if (!is_possible_time(message.time)) {  // it stands at a wrong place among the others
      ++untimed_;
      return;
    }
    const ros::Transforms transforms = transforms_of(*source_, message);
    impossible_ += transforms.impossible;
    for (const ros::Transform& t : transforms.all) {
      const std::string parent = plain_frame(t.parent), child = plain_frame(t.child);
      if (joint_.between.empty()) {
        if (parent == joint_.odom && child == joint_.base) give(t, message.time);
      } else if (parent == joint_.odom && child == joint_.between) {
        firsts_.push_back(t);
      } else if (parent == joint_.between && child == joint_.base) {
        if (seconds_.empty() || t.stamp > seconds_.back().stamp) seconds_.push_back(t);
      }
    }
    join(message.time);
  }

  void give(const ros::Transform& X_OR, Nanoseconds time) {
    ros::OdometryMessage odometry;
    odometry.X_OR = X_OR;
    waiting_.push_back({topics_.size() - 1, time, ros::write_odometry(odometry, Encoding::cdr)});
  }

  /// Gives the first joint's records with the second joint as it was at their time, which is between two of its own.
  void join(Nanoseconds time) {
    for (; !firsts_.empty(); firsts_.pop_front()) {
      const ros::Transform& first = firsts_.front();
      while (seconds_.size() > 1 && seconds_[1].stamp <= first.stamp) seconds_.pop_front();
      const bool is_known = !seconds_.empty() && seconds_.back().stamp >= first.stamp;
      if (!is_known && firsts_.size() <= most_waiting) return;
      const std::optional<Pose> second = is_known ? second_at(first.stamp) : std::nullopt;
      if (second)
        give({first.stamp, joint_.odom, joint_.base, first.X * *second}, time);
      else
        ++unjoined_;
    }
    while (seconds_.size() > most_waiting) seconds_.pop_front();
  }

  /// Between the first two; nothing where they are far apart, or both later.
  [[nodiscard]] std::optional<Pose> second_at(Nanoseconds stamp) const {
    constexpr Nanoseconds longest_gap = 500'000'000;
    const ros::Transform& before = seconds_.front();
    if (before.stamp == stamp) return before.X;
    if (before.stamp > stamp || seconds_[1].stamp - before.stamp > longest_gap) return std::nullopt;
    const auto span = static_cast<double>(seconds_[1].stamp - before.stamp);
    return interpolate(before.X, seconds_[1].X, static_cast<double>(stamp - before.stamp) / span);
  }

  static constexpr std::size_t most_waiting = 10'000;
  std::unique_ptr<MessageSource> source_;
  std::string transforms_;
  RobotJoint joint_;
  std::vector<BagTopic> topics_;  ///< the last is the odometry
  bool odometry_wanted_ = false, transforms_wanted_ = false;
  std::deque<RawMessage> waiting_;               ///< odometry of a message that was read
  std::deque<ros::Transform> firsts_, seconds_;  ///< of a chain, by time; the first until the second is known
  std::size_t impossible_ = 0, unjoined_ = 0;
  std::int64_t read_ = 0, untimed_ = 0;  ///< messages of transforms
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
