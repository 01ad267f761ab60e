// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/bag_topics.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "bim/errors.h"
#include "slam/io/bags/frame_tree.h"
#include "slam/io/bags/ros_message.h"

namespace plumbline::slam {

namespace {

constexpr std::string_view cloud_type = "sensor_msgs/PointCloud2", odometry_type = "nav_msgs/Odometry",
                           imu_type = "sensor_msgs/Imu", transforms_type = "tf2_msgs/TFMessage",
                           clock_type = "rosgraph_msgs/Clock";

using IsType = bool (*)(std::string_view);

/// The topics of a type; truth is not looked for.
std::vector<std::string> topics_of(const MessageSource& source, IsType is) {
  std::vector<std::string> names;
  for (const BagTopic& topic : source.topics())
    if (is(topic.type) && topic.encoding != Encoding::unknown && !topic.name.starts_with("/ground_truth"))
      names.push_back(topic.name);
  return names;
}
std::string first_topic(const MessageSource& source, IsType is) {
  const std::vector<std::string> names = topics_of(source, is);
  return names.empty() ? std::string() : names.front();
}

/// The frame that the first message of each topic of clouds is in, and the frames that are no LiDAR's: by convention,
/// and those in which the robot's poses are.
struct CloudFrames {
  std::map<std::string, std::string> of_topics;
  std::set<std::string> of_worlds = {"map", "odom", "world", "earth", "camera_init"};

  void add(const BagTopic& topic, const RawMessage& message) {
    try {
      if (is_odometry(topic.type))
        of_worlds.insert(plain_frame(ros::read_odometry(message.bytes, topic.encoding).X_OR.parent));
      else if (!of_topics.contains(topic.name))
        of_topics[topic.name] =
            plain_frame(is_livox(topic.type) ? ros::read_livox(message.bytes, topic.encoding).frame
                                             : ros::read_cloud(message.bytes, topic.encoding).frame);
    } catch (const InputError&) {
      return;  // said where it is read
    }
  }
  /// Of clouds that a method has put into its map, as FAST-LIO publishes them.
  [[nodiscard]] bool is_mapped(const std::string& name) const {
    const auto frame = of_topics.find(name);
    return frame != of_topics.end() && of_worlds.contains(frame->second);
  }
};

/// The first topic of clouds, but none that has few while another has many, and none in a map's frame beside others.
std::string first_scans(MessageSource& source) {
  constexpr int enough = 40;  // of one topic to compare the others with it
  constexpr int few = 8;      // times fewer; a LiDAR at 5 Hz may stand beside a camera at 30 Hz
  const std::vector<std::string> names = topics_of(source, is_cloud);
  if (names.size() < 2) return names.empty() ? std::string() : names.front();
  std::vector<std::string> selected = topics_of(source, is_odometry);
  selected.insert(selected.end(), names.begin(), names.end());
  std::map<std::string, int> counts;
  CloudFrames frames;
  int most = 0;
  source.select(selected);
  for (RawMessage message; most < enough && source.next(message);) {
    const BagTopic& topic = source.topics()[message.topic];
    frames.add(topic, message);
    if (is_cloud(topic.type)) most = std::max(most, ++counts[topic.name]);
  }
  for (const bool mapped : {false, true})
    for (const std::string& name : names)
      if (few * counts[name] >= most && frames.is_mapped(name) == mapped) return name;
  return names.front();
}

/// What a driver records before it makes clouds.
std::string packets(const MessageSource& source) {
  for (const BagTopic& topic : source.topics())
    if (topic.type.ends_with("Packet") || topic.type.ends_with("PacketMsg") || topic.type.ends_with("UdpFrame") ||
        topic.type == "velodyne_msgs/VelodyneScan")
      return "; " + topic.name + " holds packets (" + topic.type + "), which the driver makes clouds of";
  return {};
}

/// What a bag without clouds has instead, as far as it may be of a LiDAR.
std::string instead(const MessageSource& source) {
  if (const std::string found = packets(source); !found.empty()) return found;
  constexpr std::size_t most = 5;
  std::string list;
  std::size_t count = 0;
  for (const BagTopic& topic : source.topics()) {
    if (is_cloud(topic.type) && topic.encoding == Encoding::unknown)
      return "; " + topic.name + " is of " + topic.type + " in another layout than ROS has";
    if (is_odometry(topic.type) || is_imu(topic.type) || is_transforms(topic.type) || topic.type == clock_type)
      continue;
    if (++count <= most)
      list += (list.empty() ? "" : ", ") + topic.name + " (" + (topic.type.empty() ? "no type" : topic.type) + ")";
  }
  if (list.empty()) return {};
  return "; it holds " + list + (count > most ? " and " + std::to_string(count - most) + " more" : "");
}

void check_topic(const MessageSource& source, const std::string& name, IsType is, std::string_view type,
                 const Mark& mark) {
  for (const BagTopic& topic : source.topics()) {
    if (topic.name != name) continue;
    if (!is(topic.type)) throw InputError(mark, name + " is of type " + topic.type + ", not " + std::string(type));
    if (topic.encoding == Encoding::unknown)
      throw InputError(mark, name + " is of " + topic.type + " in another layout than ROS has");
    return;
  }
  throw InputError(mark, "a bag without messages on " + name);
}

}  // namespace

bool is_livox(std::string_view type) { return type.starts_with("livox_") && type.ends_with("/CustomMsg"); }
bool is_cloud(std::string_view type) { return type == cloud_type || is_livox(type); }
bool is_odometry(std::string_view type) { return type == odometry_type; }
bool is_imu(std::string_view type) { return type == imu_type; }
bool is_transforms(std::string_view type) { return type == transforms_type; }

BagTopics choose_topics(MessageSource& source, const BagTopics& asked, const Mark& mark) {
  BagTopics topics = asked;
  if (topics.points.empty()) topics.points = first_scans(source);
  if (topics.odometry.empty()) topics.odometry = first_topic(source, is_odometry);
  if (topics.imu.empty()) topics.imu = first_topic(source, is_imu);
  if (topics.points.empty())
    throw InputError(mark, "a bag without sensor_msgs/PointCloud2 or Livox's CustomMsg" + instead(source));
  check_topic(source, topics.points, is_cloud, cloud_type, mark);
  if (!topics.odometry.empty()) check_topic(source, topics.odometry, is_odometry, odometry_type, mark);
  if (!topics.imu.empty()) check_topic(source, topics.imu, is_imu, imu_type, mark);
  return topics;
}

std::vector<std::string> other_clouds(const MessageSource& source, std::string_view points) {
  std::vector<std::string> names;
  for (const BagTopic& topic : source.topics())
    if (is_cloud(topic.type) && topic.name != points) names.push_back(topic.name);
  return names;
}

std::string in_brackets(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? " (" : ", ") + name;
  return list.empty() ? list : list + ")";
}

bool holds_odometry(const MessageSource& source) { return !first_topic(source, is_odometry).empty(); }

std::string moving_transforms(const MessageSource& source) {
  for (const BagTopic& topic : source.topics())
    if (is_transforms(topic.type) && topic.encoding != Encoding::unknown && topic.name.ends_with("/tf"))
      return topic.name;
  return {};
}

std::string static_transforms(const MessageSource& source, std::string_view points) {
  constexpr std::string_view plain = "/tf_static";
  std::vector<std::string> all, beside_points;
  for (const BagTopic& topic : source.topics()) {
    if (!is_transforms(topic.type) || !topic.name.ends_with(plain)) continue;
    if (topic.name == plain) return topic.name;
    all.push_back(topic.name);
    const std::size_t slash = topic.name.size() - plain.size();
    if (points.starts_with(topic.name.substr(0, slash + 1))) beside_points.push_back(topic.name);
  }
  if (all.size() == 1) return all.front();
  return beside_points.size() == 1 ? beside_points.front() : std::string();
}

}  // namespace plumbline::slam
