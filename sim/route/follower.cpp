// SPDX-License-Identifier: Apache-2.0
#include "sim/route/follower.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/robot/failure.h"

namespace plumbline::sim {

namespace {

constexpr double step_s = 1e-9 * static_cast<double>(Robot::step_ns);

}  // namespace

Follower::Follower(const FollowerConfig& config, std::vector<Waypoint> waypoints, std::uint64_t seed)
    : config_(config), waypoints_(std::move(waypoints)), jitter_(seed, "sim.gait.command") {}

Command Follower::update(const Pose& X_WR, std::int64_t tick) {
  skip_reached(X_WR.t);
  if (done()) return {};
  check_progress(X_WR, tick);

  return jittered(waypoints_[next_].stairs ? on_stairs(X_WR) : on_level(X_WR), tick);
}

Command Follower::on_level(const Pose& X_WR) {
  const Eigen::Vector2d p_W = X_WR.t.head<2>();
  const Eigen::Vector2d ahead_W = goal(p_W) - p_W;
  const double error = wrap_angle(std::atan2(ahead_W.y(), ahead_W.x()) - X_WR.yaw());
  turning_ = std::abs(error) > (turning_ ? config_.turn_end : config_.turn_start);

  Command command;
  const double gain = turning_ ? config_.turn_gain : config_.steer_gain;
  command.yaw_rate = std::clamp(gain * error, -config_.yaw_rate_max, config_.yaw_rate_max);
  command.vx = turning_ ? 0.0 : walking_speed(error, p_W);
  return command;
}

/// Facing along the leg all the time, sideways to its line: a flight is too narrow for curves. First on the spot.
Command Follower::on_stairs(const Pose& X_WR) {
  const Eigen::Vector2d from = waypoints_[next_ - 1].p_W.head<2>();
  const Eigen::Vector2d e = (waypoints_[next_].p_W.head<2>() - from).normalized();
  const Eigen::Vector2d off = X_WR.t.head<2>() - from;
  const Eigen::Vector2d left(-e.y(), e.x());
  const double error = wrap_angle(std::atan2(e.y(), e.x()) - X_WR.yaw());
  const double side = left.dot(off);
  turning_ = turning_ && (std::abs(error) > config_.stairs_aligned || std::abs(side) > config_.stairs_centred_m);

  Eigen::Vector2d correction_W = -config_.side_gain * (turning_ ? off : Eigen::Vector2d(side * left));
  if (correction_W.norm() > config_.side_mps) correction_W *= config_.side_mps / correction_W.norm();
  const double speed = turning_ ? 0.0 : walking_speed(error, X_WR.t.head<2>());
  const Eigen::Vector2d v_R = Eigen::Rotation2Dd(-X_WR.yaw()) * (speed * e + correction_W);

  Command command;
  command.yaw_rate = std::clamp(config_.turn_gain * error, -config_.yaw_rate_max, config_.yaw_rate_max);
  command.vx = v_R.x();
  command.vy = v_R.y();
  command.gait_period_scale = config_.stairs_period_scale;
  return command;
}

void Follower::skip_reached(const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d sole_W = p_W - Eigen::Vector3d(0.0, 0.0, config_.standing_height_m);
  while (!done()) {
    const Eigen::Vector3d off = waypoints_[next_].p_W - sole_W;
    if (off.head<2>().norm() >= config_.reached_m || std::abs(off.z()) >= config_.reached_height_m) return;
    ++next_;
    if (!done() && waypoints_[next_].stairs) turning_ = true;
  }
}

void Follower::check_progress(const Pose& X_WR, std::int64_t tick) {
  const Eigen::Vector2d p_W = X_WR.t.head<2>();
  const double yaw = X_WR.yaw();
  const bool moved = (p_W - progress_point_).norm() > config_.stuck_distance_m ||
                     std::abs(wrap_angle(yaw - progress_yaw_)) > config_.stuck_angle;
  if (moved || !started_) {
    started_ = true;
    progress_point_ = p_W;
    progress_yaw_ = yaw;
    progress_tick_ = tick;
  } else if (static_cast<double>(tick - progress_tick_) * step_s > config_.stuck_s) {
    throw scenario_failure("the robot stalled", static_cast<double>(tick) * step_s, X_WR.t);
  }
}

Eigen::Vector2d Follower::goal(const Eigen::Vector2d& p_W) const {
  const Eigen::Vector2d from = waypoints_[next_ - 1].p_W.head<2>();
  const Eigen::Vector2d to = waypoints_[next_].p_W.head<2>();
  const double length = (to - from).norm();
  if (length <= 0.0) return to;
  const Eigen::Vector2d e = (to - from) / length;
  const double along = std::clamp(e.dot(p_W - from) + config_.lookahead_m, 0.0, length);
  const Eigen::Vector2d ahead = from + along * e;
  return (ahead - p_W).norm() < config_.goal_min_m ? to : ahead;
}

double Follower::walking_speed(double heading_error, const Eigen::Vector2d& p_W) const {
  const bool stairs = waypoints_[next_].stairs;
  const double speed = stairs ? std::min(config_.speed_mps, config_.stairs_mps) : config_.speed_mps;
  const double v = speed * std::max(config_.slow_min, std::cos(config_.slow_angle_gain * heading_error));
  if (next_ + 1 < waypoints_.size()) return v;
  const double distance = (waypoints_[next_].p_W.head<2>() - p_W).norm();
  return std::min(v, std::max(config_.approach_min_mps, config_.approach_gain * distance));
}

Command Follower::jittered(Command command, std::int64_t tick) const {
  const auto block = static_cast<std::uint64_t>(static_cast<double>(tick) * step_s / config_.jitter_s);
  command.vx *= 1.0 + config_.speed_jitter * (2.0 * jitter_.uniform(block, 0) - 1.0);
  command.gait_period_scale *= 1.0 + config_.period_jitter * (2.0 * jitter_.uniform(block, 1) - 1.0);
  return command;
}

}  // namespace plumbline::sim
