// SPDX-License-Identifier: Apache-2.0
#include "sim/route/pure_pursuit.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/robot/scenario_failure.h"

namespace plumbline::sim {

namespace {

constexpr double step_s = 1e-9 * static_cast<double>(Robot::step_ns);

}  // namespace

PurePursuit::PurePursuit(const PurePursuitConfig& config, std::vector<Waypoint> waypoints, Seed seed)
    : config_(config),
      waypoints_(std::move(waypoints)),
      jitter_(seed, "sim.gait.command"),
      speeds_(config.speed, waypoints_),
      progress_(config.progress) {}

Command PurePursuit::update(const Pose& X_WR, std::int64_t tick) {
  skip_reached(X_WR.t);
  if (done()) return {};
  check_progress(X_WR, tick);

  if (waypoints_[next_].stairs) return jittered(on_stairs(X_WR), tick);
  if (goes_back(X_WR, static_cast<double>(tick) * step_s)) return jittered(to_turning_place(X_WR), tick);
  return jittered(on_level(X_WR), tick);
}

Command PurePursuit::on_level(const Pose& X_WR) {
  const double error = heading_error(X_WR);
  turning_ = std::abs(error) > (turning_ ? config_.turn_end : config_.turn_start);

  Command command;
  const double gain = turning_ ? config_.turn_gain : config_.steer_gain;
  command.yaw_rate = std::clamp(gain * error, -config_.yaw_rate_max, config_.yaw_rate_max);
  command.vx = turning_ ? 0.0 : walking_speed(error, X_WR.t.head<2>());
  return command;
}

bool PurePursuit::goes_back(const Pose& X_WR, double t_s) {
  const bool stuck = turning_ && progress_.idle_s(t_s) > config_.back_after_s;
  if (t_s >= back_until_s_ && stuck && times_back_ < config_.back_times) {
    ++times_back_;
    back_until_s_ = t_s + config_.back_most_s;
  }
  if ((waypoints_[next_ - 1].p_W - X_WR.t).head<2>().norm() < config_.back_near_m) back_until_s_ = t_s;
  if (t_s < back_until_s_) progress_.begin_again(t_s);
  return t_s < back_until_s_;
}

Command PurePursuit::to_turning_place(const Pose& X_WR) const {
  const Eigen::Vector2d ahead = (waypoints_[next_ - 1].p_W - X_WR.t).head<2>();
  const double error = wrap_angle(std::atan2(ahead.y(), ahead.x()) - X_WR.yaw());
  Command command;
  command.yaw_rate = std::clamp(config_.turn_gain * error, -config_.yaw_rate_max, config_.yaw_rate_max);
  command.vx = std::abs(error) > config_.turn_end ? 0.0 : config_.back_mps;
  return command;
}

/// Facing up the flight all the time, sideways to its line: a flight is too narrow for curves. First on the spot.
Command PurePursuit::on_stairs(const Pose& X_WR) {
  const Eigen::Vector2d from = waypoints_[next_ - 1].p_W.head<2>();
  const Eigen::Vector2d e = (waypoints_[next_].p_W.head<2>() - from).normalized();
  const Eigen::Vector2d off = X_WR.t.head<2>() - from;
  const Eigen::Vector2d left(-e.y(), e.x());
  const double error = heading_error(X_WR);
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
  command.slow_gait = true;
  return command;
}

void PurePursuit::skip_reached(const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d sole_W = p_W - Eigen::Vector3d(0.0, 0.0, config_.standing_height_m);
  while (!done() && reached(sole_W)) {
    ++next_;
    times_back_ = 0;
    back_until_s_ = 0.0;
    if (!done() && waypoints_[next_].stairs) turning_ = true;
  }
}

bool PurePursuit::reached(const Eigen::Vector3d& sole_W) const {
  const Eigen::Vector3d off = waypoints_[next_].p_W - sole_W;
  if (std::abs(off.z()) >= config_.reached_height_m) return false;
  return off.head<2>().norm() < config_.reached_m || passed(sole_W.head<2>());
}

/// Only for intermediate waypoints: the robot walks up to the end of a route and to the foot of a stair.
bool PurePursuit::passed(const Eigen::Vector2d& p_W) const {
  if (waypoints_[next_].stairs || next_ + 1 >= waypoints_.size() || waypoints_[next_ + 1].stairs) return false;
  const Eigen::Vector2d segment = (waypoints_[next_].p_W - waypoints_[next_ - 1].p_W).head<2>();
  const Eigen::Vector2d beyond = p_W - waypoints_[next_].p_W.head<2>();
  return segment.dot(beyond) > 0.0 && beyond.norm() < config_.passed_m;
}

double PurePursuit::heading_error(const Pose& X_WR) const {
  const Eigen::Vector2d p_W = X_WR.t.head<2>();
  const Eigen::Vector3d segment = waypoints_[next_].p_W - waypoints_[next_ - 1].p_W;
  // Down a flight backwards: the knees point back, and facing down the shanks would meet the edges of the treads.
  const double sign = segment.z() < -config_.landing_m ? -1.0 : 1.0;
  const Eigen::Vector2d ahead = waypoints_[next_].stairs ? Eigen::Vector2d(sign * segment.head<2>()) : goal(p_W) - p_W;
  return wrap_angle(std::atan2(ahead.y(), ahead.x()) - X_WR.yaw());
}

void PurePursuit::check_progress(const Pose& X_WR, std::int64_t tick) {
  const double t_s = static_cast<double>(tick) * step_s;
  const double left_m = (waypoints_[next_].p_W - X_WR.t).head<2>().norm();
  if (progress_.stalled(next_, waypoints_[next_].stairs, left_m, heading_error(X_WR), t_s))
    throw scenario_failure("the robot stalled", t_s, X_WR.t);
}

Eigen::Vector2d PurePursuit::goal(const Eigen::Vector2d& p_W) const {
  const Eigen::Vector2d from = waypoints_[next_ - 1].p_W.head<2>();
  const Eigen::Vector2d to = waypoints_[next_].p_W.head<2>();
  const double length = (to - from).norm();
  if (length <= 0.0) return to;
  const Eigen::Vector2d e = (to - from) / length;
  const double lookahead = std::max(config_.lookahead_m, config_.lookahead_s * speeds_.limit(next_, length));
  const double along = std::clamp(e.dot(p_W - from) + lookahead, 0.0, length);
  const Eigen::Vector2d ahead = from + along * e;
  return (ahead - p_W).norm() < config_.goal_min_m ? to : ahead;
}

double PurePursuit::walking_speed(double heading_error, const Eigen::Vector2d& p_W) const {
  const double left_m = (waypoints_[next_].p_W.head<2>() - p_W).norm();
  const double speed = speeds_.limit(next_, left_m - config_.reached_m);
  const double v = speed * std::max(config_.slow_min, std::cos(config_.slow_angle_gain * heading_error));
  if (next_ + 1 < waypoints_.size()) return v;
  return std::min(v, std::max(config_.approach_min_mps, config_.approach_gain * left_m));
}

Command PurePursuit::jittered(Command command, std::int64_t tick) const {
  const auto block = static_cast<std::uint64_t>(static_cast<double>(tick) * step_s / config_.jitter_s);
  command.vx *= 1.0 + config_.speed_jitter * (2.0 * jitter_.uniform(block, 0) - 1.0);
  command.gait_period_scale *= 1.0 + config_.period_jitter * (2.0 * jitter_.uniform(block, 1) - 1.0);
  return command;
}

}  // namespace plumbline::sim
