// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/frame_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <numbers>

#include "slam/io/bags/record_queue.h"

namespace plumbline::slam {

namespace {

constexpr int longest_chain = 16;

bool is_apart(const Pose& a, const Pose& b, double most_m, double most_rad) {
  return (a.t - b.t).norm() > most_m || a.q.angularDistance(b.q) > most_rad;
}

/// "(0.2, 0, 0) m with yaw 90, pitch 0, roll 0 deg"
std::string words_of(const Pose& X) {
  constexpr double degrees = 180.0 / std::numbers::pi;
  const Eigen::Matrix3d R = X.q.toRotationMatrix();
  const double pitch = std::asin(std::clamp(-R(2, 0), -1.0, 1.0)), roll = std::atan2(R(2, 1), R(2, 2));
  std::array<char, 160> text{};
  const auto plain = [](double value) { return std::abs(value) < 1e-9 ? 0.0 : value; };
  std::snprintf(text.data(), text.size(), "(%.4g, %.4g, %.4g) m with yaw %.4g, pitch %.4g, roll %.4g deg",
                plain(X.t.x()), plain(X.t.y()), plain(X.t.z()), plain(degrees * X.yaw()), plain(degrees * pitch),
                plain(degrees * roll));
  return text.data();
}

}  // namespace

std::string plain_frame(const std::string& frame) { return frame.starts_with('/') ? frame.substr(1) : frame; }

void FrameTree::add(const ros::Transform& transform) {
  constexpr double rounding_m = 1e-4, rounding_rad = 1e-4;
  const std::string child = plain_frame(transform.child), parent = plain_frame(transform.parent);
  const auto [joint, is_new] = mounts_[child].try_emplace(parent, transform.X);
  if (!is_new && is_apart(joint->second, transform.X, rounding_m, rounding_rad))
    changed_.try_emplace({child, parent}, joint->second);
  joint->second = transform.X;
}

std::vector<std::string> FrameTree::left_out(const std::string& topic) const {
  std::vector<std::string> all;
  if (impossible_ > 0) all.push_back(ros::impossible_transforms(topic, impossible_));
  for (const auto& [joint, first] : changed_) {
    const auto& [child, parent] = joint;
    all.push_back(topic + ": '" + child + "' lies in '" + parent + "' with several values, first at " +
                  words_of(first) + ", last at " + words_of(mounts_.at(child).at(parent)) + "; the last one is taken");
  }
  return all;
}

std::optional<Pose> FrameTree::find(const std::string& frame, const std::string& base) const {
  const std::vector<Above> above_frame = all_above(plain_frame(frame));
  for (const Above& of_base : all_above(plain_frame(base)))
    for (const Above& of_frame : above_frame)
      if (of_frame.name == of_base.name) return of_base.X.inverse() * of_frame.X;
  return std::nullopt;
}

std::vector<FrameTree::Above> FrameTree::all_above(const std::string& frame) const {
  std::vector<Above> above = {{frame, Pose(), 0}};
  for (std::size_t i = 0; i < above.size(); ++i) {
    const auto mounts = mounts_.find(above[i].name);
    if (mounts == mounts_.end() || above[i].joints == longest_chain) continue;
    for (const auto& [parent, X] : mounts->second) {
      const bool known = std::any_of(above.begin(), above.end(),
                                     [&, &name = parent](const Above& other) { return other.name == name; });
      if (!known) above.push_back({parent, X * above[i].X, above[i].joints + 1});
    }
  }
  return above;
}

void StillJoints::add(const ros::Transform& transform) {
  constexpr double still_m = 1e-9, still_rad = 1e-9;
  const auto [place, is_new] = joints_.try_emplace(plain_frame(transform.child), Joint{transform});
  if (is_new) return;
  Joint& joint = place->second;
  const Pose& X = joint.first.X;
  joint.repeated = true;
  joint.moved = joint.moved || plain_frame(transform.parent) != plain_frame(joint.first.parent) ||
                is_apart(transform.X, X, still_m, still_rad);
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
