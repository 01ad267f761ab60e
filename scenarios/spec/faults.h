// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "bim/config/visit.h"
#include "sim/faults.h"

namespace plumbline::scenarios {

/// Errors that no estimator is told of. A size that is not given is as the preset has it.
struct FaultsSpec {
  sim::FaultsPreset preset = sim::FaultsPreset::none;
  std::optional<double> clock_offset_s;
  std::optional<double> clock_jitter_s;
  std::optional<double> mount_error_m;
  std::optional<double> mount_error_deg;
  std::optional<std::vector<double>> mount_offset_m;
  std::optional<std::vector<double>> mount_rotation_deg;
  std::optional<double> gyro_bias_radps;
  std::optional<double> accelerometer_bias;
  std::optional<double> imu_scale;
  std::optional<double> slip_mps;
  std::optional<double> slip_s;
  std::optional<double> slip_every_s;
  template <class V>
  void visit(V& v) {
    v("preset", preset, Field{.doc = "preset of the sizes; harsh: every one of them moderate"});
    v("clock_offset_s", clock_offset_s,
      Field{.doc = "how late the stamps of odometry and IMU are against the LiDAR's", .min = -0.5, .max = 0.5});
    v("clock_jitter_s", clock_jitter_s,
      Field{.doc = "standard deviation of these stamps, whose order stays", .min = 0.0, .max = 0.1});
    v("mount_error_m", mount_error_m,
      Field{.doc = "error of the nominal position of the LiDAR, in a direction drawn from the seed",
            .min = 0.0,
            .max = 1.0});
    v("mount_error_deg", mount_error_deg,
      Field{.doc = "error of the nominal attitude of the LiDAR, about an axis drawn from the seed",
            .min = 0.0,
            .max = 30.0});
    v("mount_offset_m", mount_offset_m,
      Field{.doc = "error of the nominal position [x, y, z] in the robot's frame, instead of a drawn one",
            .min = -1.0,
            .max = 1.0});
    v("mount_rotation_deg", mount_rotation_deg,
      Field{.doc = "error of the nominal attitude as a rotation vector [x, y, z] in the LiDAR's frame, instead of a "
                   "drawn one",
            .min = -30.0,
            .max = 30.0});
    v("gyro_bias_radps", gyro_bias_radps,
      Field{.doc = "bias of the gyro on each axis, with signs drawn from the seed", .min = 0.0, .max = 1.0});
    v("accelerometer_bias", accelerometer_bias,
      Field{.doc = "bias of the accelerometer on each axis, with signs drawn from the seed",
            .unit = "m/s²",
            .min = 0.0,
            .max = 10.0});
    v("imu_scale", imu_scale,
      plain_field("relative scale error of gyro and accelerometer on each axis, with signs drawn from the seed",
                  {.min = 0.0, .max = 0.5}));
    v("slip_mps", slip_mps,
      Field{.doc = "speed at which the standing feet slide in an episode, as the encoders see it; 0: never",
            .min = 0.0,
            .max = 5.0});
    v("slip_s", slip_s, Field{.doc = "duration of an episode of slipping", .min = 0.002, .max = 10.0});
    v("slip_every_s", slip_every_s,
      Field{.doc = "length of the time spans, with one episode of slipping in each", .min = 0.1, .max = 3600.0});
  }
};

/// The preset with the sizes that are given; none without a spec.
[[nodiscard]] sim::Faults faults(const std::optional<FaultsSpec>& spec);
/// Throws InputError at the mark of the block where a vector is not of 3 numbers or a slip outlasts its span.
void check_faults(const std::optional<FaultsSpec>& spec, const Mark& mark);

}  // namespace plumbline::scenarios
