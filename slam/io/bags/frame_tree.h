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
  /// Pose of a frame in `base`; nothing where no chain of at most 16 frames leads from each up to one frame.
  [[nodiscard]] std::optional<Pose> find(const std::string& frame, const std::string& base) const;
  [[nodiscard]] bool empty() const { return mounts_.empty(); }

 private:
  /// Of a frame in one above it, or in itself.
  [[nodiscard]] std::optional<Pose> find_above(const std::string& frame, const std::string& above) const;

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
