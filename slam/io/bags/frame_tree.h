// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>

#include "slam/io/bags/ros_message.h"

namespace plumbline::slam {

/// A frame's name as all writers mean it: without a slash before it.
[[nodiscard]] std::string plain_frame(const std::string& frame);

/// Frames that stand still to each other, as /tf_static has them.
class FrameTree {
 public:
  void add(const ros::Transform& transform);
  /// Pose of a frame in `base`; nothing where no chain of at most 16 frames leads from the one up to the other.
  [[nodiscard]] std::optional<Pose> find(const std::string& frame, const std::string& base) const;

 private:
  struct Mount {
    std::string parent;
    Pose X;
  };

  std::map<std::string, Mount> mounts_;  ///< by child
};

/// An IMU's measurements along the axes of R, whose frame is `base`; what its lever arm adds to the acceleration is
/// left in. A frame without a name is R, and where R has none, no other frame can be resolved. Nothing where the tree
/// does not join them.
[[nodiscard]] std::optional<Imu> in_robot(const ros::FramedImu& said, const FrameTree& frames, const std::string& base);

}  // namespace plumbline::slam
