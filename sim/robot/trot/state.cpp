// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/trot/state.h"

namespace plumbline::sim {

PerLeg<Eigen::Vector3d> zero_per_leg() {
  PerLeg<Eigen::Vector3d> zero;
  zero.fill(Eigen::Vector3d::Zero());
  return zero;
}

Posture posture_of(const BodyState& state) {
  Posture posture;
  posture.yaw = state.X_WR.yaw();
  for (std::size_t leg = 0; leg < leg_count; ++leg) {
    posture.foot_W[leg] = state.X_WR * foot_R(leg, state.q[leg]);
    posture.jacobian_R[leg] = foot_jacobian_R(leg, state.q[leg]);
  }
  return posture;
}

}  // namespace plumbline::sim
