// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/geometry/pose.h"
#include "sim/robot/trot/trot_config.h"
#include "sim/robot/types/command.h"

namespace plumbline::sim {

/// Smooth references from a raw command: slewed velocities and pose references with a bounded lag.
class Reference {
 public:
  Reference(const CommandConfig& config, const Pose& X_WR);

  /// One step of dt seconds towards the command, given in the heading frame.
  void update(const Command& command, const Pose& X_WR, double dt);

  [[nodiscard]] double yaw_rate() const { return yaw_rate_; }        ///< rad/s
  [[nodiscard]] double speed() const { return velocity_.norm(); }    ///< m/s
  [[nodiscard]] const Eigen::Vector3d& v_W() const { return v_W_; }  ///< horizontal, m/s
  [[nodiscard]] const Eigen::Vector2d& position_W() const { return position_W_; }
  [[nodiscard]] double yaw() const { return yaw_; }  ///< rad

 private:
  CommandConfig config_;
  Eigen::Vector2d velocity_ = Eigen::Vector2d::Zero();  ///< in the heading frame
  double yaw_rate_ = 0.0;
  Eigen::Vector3d v_W_ = Eigen::Vector3d::Zero();
  Eigen::Vector2d position_W_;
  double yaw_;
};

}  // namespace plumbline::sim
