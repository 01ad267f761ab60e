// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/imu_error.h"

#include "bim/random/stream.h"

namespace plumbline::sim {

namespace {

constexpr std::uint32_t gyro_bias_lane = 0;
constexpr std::uint32_t gyro_scale_lane = 1;
constexpr std::uint32_t accelerometer_bias_lane = 2;
constexpr std::uint32_t accelerometer_scale_lane = 3;

Eigen::Vector3d signs(const Stream& stream, std::uint32_t lane) {
  Eigen::Vector3d out;
  for (std::uint32_t axis = 0; axis < 3; ++axis) out(axis) = stream.uniform(0, lane, axis) < 0.5 ? -1.0 : 1.0;
  return out;
}

}  // namespace

std::optional<ImuErrorDraw> draw(const ImuError& error, std::uint64_t seed) {
  if (error.gyro_bias == 0.0 && error.accelerometer_bias == 0.0 && error.scale == 0.0) return std::nullopt;
  ImuErrorDraw out;
  const Stream stream(seed, "sim.faults.imu");
  out.gyro_bias_R = error.gyro_bias * signs(stream, gyro_bias_lane);
  out.gyro_scale += error.scale * signs(stream, gyro_scale_lane);
  out.accelerometer_bias_R = error.accelerometer_bias * signs(stream, accelerometer_bias_lane);
  out.accelerometer_scale += error.scale * signs(stream, accelerometer_scale_lane);
  return out;
}

}  // namespace plumbline::sim
