// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/leg_slope.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace plumbline::sim {

void LegSlope::update(const std::array<Eigen::Vector3d, 4>& foot_O, const std::array<bool, 4>& stands, double dt) {
  for (std::size_t leg = 0; leg < stood_O_.size(); ++leg) {
    if (!stands[leg]) continue;
    stood_O_[leg] = foot_O[leg];
    known_[leg] = true;
  }
  if (!std::all_of(known_.begin(), known_.end(), [](bool known) { return known; })) return;
  Eigen::Vector3d mean_O = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p_O : stood_O_) mean_O += 0.25 * p_O;
  Eigen::Matrix2d N = config_.damping * Eigen::Matrix2d::Identity();
  Eigen::Vector2d rhs = Eigen::Vector2d::Zero();
  for (const Eigen::Vector3d& p_O : stood_O_) {
    const Eigen::Vector3d d = p_O - mean_O;
    N += d.head<2>() * d.head<2>().transpose();
    rhs += d.head<2>() * d.z();
  }
  const Eigen::Vector2d climb = N.inverse() * rhs;
  const Eigen::Vector3d normal_O = Eigen::Vector3d(-climb.x(), -climb.y(), 1.0).normalized();
  fitted_O_ = (fitted_O_ + std::min(1.0, dt / config_.time_constant_s) * (normal_O - fitted_O_)).normalized();
}

Eigen::Vector3d LegSlope::normal_O() const {
  return fitted_O_.z() < std::cos(config_.ramp_max) ? Eigen::Vector3d::UnitZ() : fitted_O_;
}

}  // namespace plumbline::sim
