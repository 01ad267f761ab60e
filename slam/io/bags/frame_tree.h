// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "slam/io/bags/ros_message.h"

namespace plumbline::slam {

/// A frame's name as all writers mean it: without a slash before it.
[[nodiscard]] std::string plain_frame(const std::string& frame);

/// Frames that stand still to each other, as /tf_static has them.
class FrameTree {
 public:
  /// A joint that is there already keeps the values of the last one that was added.
  void add(const ros::Transform& transform);
  /// Transforms that hold numbers that are no pose.
  void add_impossible(std::size_t transforms) { impossible_ += transforms; }
  /// Sentences on what of the topic's transforms was not used.
  [[nodiscard]] std::vector<std::string> left_out(const std::string& topic) const;
  /// Pose of a frame in `base`; nothing where no chain of at most 16 frames leads from each up to one frame.
  [[nodiscard]] std::optional<Pose> find(const std::string& frame, const std::string& base) const;
  [[nodiscard]] bool empty() const { return mounts_.empty(); }

 private:
  struct Above {
    std::string name;
    Pose X;  ///< of the frame in it
    int joints = 0;
  };
  /// A frame and those above it, the nearest first.
  [[nodiscard]] std::vector<Above> all_above(const std::string& frame) const;

  /// By child and parent: some drivers give a frame two parents, as the robot and the map.
  std::map<std::string, std::map<std::string, Pose>> mounts_;
  std::map<std::pair<std::string, std::string>, Pose>
      changed_;                 ///< first values of joints, child and parent, with several
  std::size_t impossible_ = 0;  ///< transforms
};

/// Joints on /tf that are published again and again and never move, as ROS 1 publishes mounts.
class StillJoints {
 public:
  void add(const ros::Transform& transform);
  [[nodiscard]] std::vector<ros::Transform> found() const;

 private:
  struct Joint {
    ros::Transform first;
    bool repeated = false;
    bool moved = false;
  };

  std::map<std::string, Joint> joints_;  ///< by child
};

/// The frame of a topic's first record that names one. Records in another, as of a second sensor, are counted.
class OneFrame {
 public:
  /// A record without a frame is taken.
  [[nodiscard]] bool takes(const std::string& frame);
  [[nodiscard]] std::int64_t others() const { return others_; }
  /// "2 of 7 scans in frame 'rear', not in 'front' as the first". what: the records; taken: how many were.
  [[nodiscard]] std::string others_of(std::int64_t taken, std::string_view what) const;

 private:
  std::string frame_, other_;
  std::int64_t others_ = 0;
};

/// The frame that a robot has by convention, base_link or base_footprint, where the tree joins the LiDAR's to it; empty
/// where it does not.
[[nodiscard]] std::string robot_above(const std::string& lidar, const FrameTree& frames);

/// m/s² of the unit that accelerations are in: drivers of Livox give g, and what is near 1 at rest is no m/s².
[[nodiscard]] double gravity_in(const Imu& first);

/// An IMU's measurements along the axes of R, whose frame is `base`; what its lever arm adds to the acceleration is
/// left in. A frame without a name is R, and where R has none, no other frame can be resolved. Nothing where the tree
/// does not join them.
[[nodiscard]] std::optional<Imu> in_robot(const ros::FramedImu& said, const FrameTree& frames, const std::string& base);

}  // namespace plumbline::slam
