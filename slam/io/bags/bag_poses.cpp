// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/bag_poses.h"

#include <algorithm>
#include <memory>

#include "bim/errors.h"
#include "slam/io/bags/bag_source.h"
#include "slam/io/bags/ros_message.h"
#include "slam/io/recordings/tum.h"

namespace plumbline::slam {

namespace {

/// The topics whose messages are poses, in words.
std::string pose_topics(const MessageSource& source) {
  std::string list;
  for (const BagTopic& topic : source.topics())
    if (ros::holds_poses(topic.type)) list += (list.empty() ? "" : ", ") + topic.name + " (" + topic.type + ")";
  return list.empty() ? "; it holds no topic of poses" : "; poses are on " + list;
}

const BagTopic& pose_topic(const MessageSource& source, const std::string& name, const Mark& mark) {
  const auto& topics = source.topics();
  const auto found = std::find_if(topics.begin(), topics.end(), [&](const BagTopic& t) { return t.name == name; });
  if (found == topics.end()) throw InputError(mark, "a bag without messages on " + name + pose_topics(source));
  if (!ros::holds_poses(found->type))
    throw InputError(mark, name + " is of type " + found->type + ", which is no pose" + pose_topics(source));
  if (found->encoding == Encoding::unknown)
    throw InputError(mark, name + " is of " + found->type + " in another layout than ROS has");
  return *found;
}

bool is_same(const StampedPose& a, const StampedPose& b) {
  return a.stamp == b.stamp && a.X_FR.t == b.X_FR.t && a.X_FR.q.coeffs() == b.X_FR.q.coeffs();
}

}  // namespace

std::vector<StampedPose> read_bag_poses(const std::string& path, const std::string& topic) {
  const Mark mark{path, 0, 0};
  const std::unique_ptr<MessageSource> source = open_source(path);
  const auto [name, type, encoding] = pose_topic(*source, topic, mark);
  std::vector<StampedPose> poses;
  source->select({name});
  for (RawMessage message; source->next(message);) {
    std::vector<StampedPose> said;
    try {
      said = ros::read_poses(type, message.bytes, encoding);
    } catch (const InputError& error) {
      throw InputError(mark, name + " holds " + error.what());
    }
    if (type == "nav_msgs/Path") poses.clear();
    for (const StampedPose& pose : said)
      if (poses.empty() || !is_same(poses.back(), pose)) poses.push_back(pose);
  }
  if (poses.empty()) throw InputError(mark, name + " holds no pose");
  const auto back = std::adjacent_find(poses.begin(), poses.end(),
                                       [](const StampedPose& a, const StampedPose& b) { return b.stamp <= a.stamp; });
  if (back != poses.end())
    throw InputError(mark, name + ": stamps must increase from pose to pose; after " + format_stamp(back->stamp) +
                               " s comes " + format_stamp(std::next(back)->stamp) + " s");
  return poses;
}

}  // namespace plumbline::slam
