// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/frame_tree.h"

#include <cmath>

#include "slam/io/bags/record_queue.h"

namespace plumbline::slam {

namespace {

constexpr int longest_chain = 16;

}  // namespace

std::string plain_frame(const std::string& frame) { return frame.starts_with('/') ? frame.substr(1) : frame; }

void FrameTree::add(const ros::Transform& transform) {
  mounts_[plain_frame(transform.child)] = {plain_frame(transform.parent), transform.X};
}

std::optional<Pose> FrameTree::find(const std::string& frame, const std::string& base) const {
  std::string common = plain_frame(base);
  if (const std::optional<Pose> X = find_above(plain_frame(frame), common)) return X;
  for (int i = 0; i < longest_chain; ++i) {
    const auto mount = mounts_.find(common);
    if (mount == mounts_.end()) return std::nullopt;
    common = mount->second.parent;
    const std::optional<Pose> X_CB = find_above(plain_frame(base), common);
    if (const std::optional<Pose> X_CF = find_above(plain_frame(frame), common); X_CB && X_CF)
      return X_CB->inverse() * *X_CF;
  }
  return std::nullopt;
}

std::optional<Pose> FrameTree::find_above(const std::string& frame, const std::string& there) const {
  std::string here = frame;
  Pose X;  // of `frame` in `here`
  for (int i = 0; here != there; ++i) {
    const auto mount = mounts_.find(here);
    if (mount == mounts_.end() || i == longest_chain) return std::nullopt;
    X = mount->second.X * X;
    here = mount->second.parent;
  }
  return X;
}

void StillJoints::add(const ros::Transform& transform) {
  constexpr double still_m = 1e-9, still_rad = 1e-9;
  const auto [place, is_new] = joints_.try_emplace(plain_frame(transform.child), Joint{transform});
  if (is_new) return;
  Joint& joint = place->second;
  const Pose& X = joint.first.X;
  joint.repeated = true;
  joint.moved = joint.moved || plain_frame(transform.parent) != plain_frame(joint.first.parent) ||
                (transform.X.t - X.t).norm() > still_m || transform.X.q.angularDistance(X.q) > still_rad;
}

std::vector<ros::Transform> StillJoints::found() const {
  std::vector<ros::Transform> still;
  for (const auto& [child, joint] : joints_)
    if (joint.repeated && !joint.moved) still.push_back(joint.first);
  return still;
}

bool OneFrame::takes(const std::string& frame) {
  const std::string name = plain_frame(frame);
  if (frame_.empty()) frame_ = name;
  if (name.empty() || name == frame_) return true;
  if (others_++ == 0) other_ = name;
  return false;
}

std::string OneFrame::others_of(std::int64_t taken, std::string_view what) const {
  return share_of(others_, taken + others_, what) + " in frame '" + other_ + "', not in '" + frame_ + "' as the first";
}

std::string robot_above(const std::string& lidar, const FrameTree& frames) {
  for (const char* name : {"base_link", "base_footprint"})
    if (lidar != name && frames.find(lidar, name)) return name;
  return {};
}

double gravity_in(const Imu& first) {
  constexpr double standard_gravity = 9.80665, tolerance = 0.15;
  return std::abs(first.linear_acceleration_R.norm() - 1.0) < tolerance ? standard_gravity : 1.0;
}

std::optional<Imu> in_robot(const ros::FramedImu& said, const FrameTree& frames, const std::string& base) {
  const std::string frame = plain_frame(said.frame), robot = plain_frame(base);
  if (frame.empty() || robot.empty() || frame == robot) return said.imu;
  const std::optional<Pose> X_RS = frames.find(frame, robot);
  if (!X_RS) return std::nullopt;
  return Imu{said.imu.stamp, X_RS->q * said.imu.angular_velocity_R, X_RS->q * said.imu.linear_acceleration_R};
}

}  // namespace plumbline::slam
