// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/faults.h"

#include <numbers>

#include "bim/errors.h"

namespace plumbline::scenarios {

namespace {

constexpr double rad = std::numbers::pi / 180.0;

std::optional<Eigen::Vector3d> vector3(const std::optional<std::vector<double>>& numbers, double unit) {
  if (!numbers) return std::nullopt;
  return unit * Eigen::Vector3d(numbers->at(0), numbers->at(1), numbers->at(2));
}

void check_vector(const std::optional<std::vector<double>>& numbers, const char* key, const Mark& mark) {
  if (numbers && numbers->size() != 3) throw InputError(mark, std::string(key) + " must be 3 numbers: [x, y, z]");
}

}  // namespace

sim::Faults faults(const std::optional<FaultsSpec>& spec) {
  if (!spec) return {};
  sim::Faults out = sim::faults_of(spec->preset);
  const auto set = [](double& value, const std::optional<double>& given) { value = given.value_or(value); };
  set(out.clock.offset_s, spec->clock_offset_s);
  set(out.clock.jitter_s, spec->clock_jitter_s);
  set(out.mount.length_m, spec->mount_error_m);
  if (spec->mount_error_deg) out.mount.angle_rad = rad * *spec->mount_error_deg;
  out.mount.offset_R = vector3(spec->mount_offset_m, 1.0);
  out.mount.rotation_L = vector3(spec->mount_rotation_deg, rad);
  set(out.imu.gyro_bias, spec->gyro_bias_radps);
  set(out.imu.accelerometer_bias, spec->accelerometer_bias);
  set(out.imu.scale, spec->imu_scale);
  set(out.slip.speed_mps, spec->slip_mps);
  set(out.slip.duration_s, spec->slip_s);
  set(out.slip.every_s, spec->slip_every_s);
  return out;
}

void check_faults(const std::optional<FaultsSpec>& spec, const Mark& mark) {
  if (!spec) return;
  check_vector(spec->mount_offset_m, "mount_offset_m", mark);
  check_vector(spec->mount_rotation_deg, "mount_rotation_deg", mark);
  const sim::SlipConfig usual;
  if (3.0 * spec->slip_s.value_or(usual.duration_s) > spec->slip_every_s.value_or(usual.every_s))
    throw InputError(mark, "slip_s must be at most a third of slip_every_s");
}

}  // namespace plumbline::scenarios
