// SPDX-License-Identifier: Apache-2.0
#include "sim/mount_error.h"

#include "bim/random/stream.h"

namespace plumbline::sim {

namespace {

constexpr std::uint32_t position_lane = 0;
constexpr std::uint32_t attitude_lane = 1;

/// A vector of this length in a random direction.
Eigen::Vector3d drawn(std::uint64_t seed, std::uint32_t lane, double length) {
  if (length == 0.0) return Eigen::Vector3d::Zero();
  const Stream stream(seed, "sim.faults.mount");
  const Eigen::Vector3d v(stream.gauss(0, lane, 0), stream.gauss(0, lane, 1), stream.gauss(0, lane, 2));
  return length * v.normalized();
}

}  // namespace

slam::Calibration told_calibration(const slam::Calibration& truth, const MountError& error, std::uint64_t seed) {
  const Eigen::Vector3d offset_R = error.offset_R ? *error.offset_R : drawn(seed, position_lane, error.length_m);
  const Eigen::Vector3d rotation_L = error.rotation_L ? *error.rotation_L : drawn(seed, attitude_lane, error.angle_rad);
  slam::Calibration told = truth;
  if (!offset_R.isZero(0.0)) {
    told.X_RL.t += offset_R;
    told.sensor_height_m += offset_R.z();
  }
  if (!rotation_L.isZero(0.0)) told.X_RL.q = (truth.X_RL.q * exp_so3(rotation_L)).normalized();
  return told;
}

}  // namespace plumbline::sim
