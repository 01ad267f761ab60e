// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/trot/reference.h"

#include <algorithm>
#include <cmath>

namespace plumbline::sim {

namespace {

double slew(double value, double target, double step) { return value + std::clamp(target - value, -step, step); }

}  // namespace

Reference::Reference(const CommandConfig& config, const Pose& X_WR)
    : config_(config), position_W_(X_WR.t.head<2>()), yaw_(X_WR.yaw()) {}

void Reference::update(const Command& command, const Pose& X_WR, double dt) {
  velocity_.x() = slew(velocity_.x(), command.vx, config_.acceleration * dt);
  velocity_.y() = slew(velocity_.y(), command.vy, config_.acceleration * dt);
  yaw_rate_ = slew(yaw_rate_, command.yaw_rate, config_.yaw_acceleration * dt);

  const double yaw_R = X_WR.yaw();
  const double s = std::sin(yaw_R);
  const double c = std::cos(yaw_R);
  v_W_ = {c * velocity_.x() - s * velocity_.y(), s * velocity_.x() + c * velocity_.y(), 0.0};

  const double ahead = wrap_angle(yaw_ + yaw_rate_ * dt - yaw_R);
  yaw_ = wrap_angle(yaw_R + std::clamp(ahead, -config_.yaw_lag_max, config_.yaw_lag_max));

  const Eigen::Vector2d lead = position_W_ + v_W_.head<2>() * dt - X_WR.t.head<2>();
  const double distance = lead.norm();
  const double keep = distance > config_.position_lag_max_m ? config_.position_lag_max_m / distance : 1.0;
  position_W_ = X_WR.t.head<2>() + keep * lead;
}

}  // namespace plumbline::sim
