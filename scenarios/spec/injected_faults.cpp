// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/injected_faults.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "sim/robot/robot.h"
#include "sim/robot/slip.h"

namespace plumbline::scenarios {

namespace {

/// Six digits, so that degrees that became radians are shown as they were written.
std::string shown(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

std::string shown(const Eigen::Vector3d& v, double unit) {
  return "[" + shown(v.x() / unit) + ", " + shown(v.y() / unit) + ", " + shown(v.z() / unit) + "]";
}

void add_clock(const sim::ClockConfig& clock, std::vector<std::string>& said) {
  if (clock.offset_s != 0.0)
    said.push_back("stamps of odometry and IMU are " + shown(std::abs(clock.offset_s)) + " s " +
                   (clock.offset_s > 0.0 ? "late" : "early"));
  const std::string these = clock.offset_s != 0.0 ? "these stamps" : "stamps of odometry and IMU";
  if (clock.jitter_s != 0.0) said.push_back(these + " jitter by " + shown(clock.jitter_s) + " s");
}

void add_mount(const sim::MountError& mount, std::vector<std::string>& said) {
  constexpr double degree = std::numbers::pi / 180.0;
  const std::string told = "methods are told a mount of the LiDAR that is off by ";
  if (mount.offset_R && !mount.offset_R->isZero(0.0))
    said.push_back(told + shown(*mount.offset_R, 1.0) + " m");
  else if (!mount.offset_R && mount.length_m != 0.0)
    said.push_back(told + shown(mount.length_m) + " m");
  if (mount.rotation_L && !mount.rotation_L->isZero(0.0))
    said.push_back(told + shown(*mount.rotation_L, degree) + "°");
  else if (!mount.rotation_L && mount.angle_rad != 0.0)
    said.push_back(told + shown(mount.angle_rad / degree) + "°");
}

void add_imu(const sim::ImuError& imu, std::vector<std::string>& said) {
  if (imu.gyro_bias != 0.0) said.push_back("the gyro has a bias of " + shown(imu.gyro_bias) + " rad/s");
  if (imu.accelerometer_bias != 0.0)
    said.push_back("the accelerometer has a bias of " + shown(imu.accelerometer_bias) + " m/s²");
  if (imu.scale != 0.0) said.push_back("the IMU's scale is off by " + shown(100.0 * imu.scale) + " %");
}

void add_lidar(const sim::LidarConfig& lidar, std::vector<std::string>& said) {
  if (lidar.distance_bias_m != 0.0)
    said.push_back("ranges err with the distance by up to " + shown(std::abs(lidar.distance_bias_m)) + " m");
  if (lidar.reflectivity_bias_m != 0.0)
    said.push_back("ranges err with the reflectivity by " + shown(std::abs(lidar.reflectivity_bias_m)) + " m a decade");
  if (lidar.incidence_bias_m != 0.0)
    said.push_back("ranges err with the incidence by " + shown(std::abs(lidar.incidence_bias_m)) +
                   " m at 10 m and 80°");
  if (lidar.warm_up_m != 0.0)
    said.push_back("ranges of the cold sensor err by " + shown(std::abs(lidar.warm_up_m)) + " m");
  if (lidar.airborne_per_m != 0.0)
    said.push_back("dust or rain gives " + shown(100.0 * lidar.airborne_per_m) + " % of the beams back in each metre");
}

}  // namespace

std::vector<std::string> injected_faults(const Scenario& scenario) {
  std::vector<std::string> said;
  const sim::Faults all = faults(scenario.faults);
  if (all.slip.speed_mps != 0.0)
    said.push_back("the feet slip at " + shown(all.slip.speed_mps) + " m/s, for " + shown(all.slip.duration_s) +
                   " s in every " + shown(all.slip.every_s) + " s");
  add_clock(all.clock, said);
  add_mount(all.mount, said);
  add_imu(all.imu, said);
  add_lidar(lidar_config(scenario.lidar), said);
  const GroundSpec level;
  if (scenario.ground.friction != level.friction)
    said.push_back("the ground's friction is " + shown(scenario.ground.friction));
  if (scenario.ground.uneven_mm != level.uneven_mm)
    said.push_back("the ground is uneven by " + shown(scenario.ground.uneven_mm) + " mm");
  if (scenario.pushes.max_n > 0.0)
    said.push_back("the robot is pushed with up to " + shown(scenario.pushes.max_n) + " N every " +
                   shown(scenario.pushes.every_s) + " s");
  if (scenario.kidnap) said.emplace_back("the robot is kidnapped");
  return said;
}

std::optional<SlipEpisode> slip_before(const Scenario& scenario, double t_s) {
  constexpr double step_s = 1e-9 * static_cast<double>(sim::Robot::step_ns);
  const sim::SlipConfig config = faults(scenario.faults).slip;
  if (config.speed_mps <= 0.0 || scenario.kidnap || !(t_s >= 0.0)) return std::nullopt;
  const sim::Slips slips(config, step_s, Seed(scenario.seed));
  const auto slipping = [&](std::int64_t step) { return !slips.velocity_R(step).isZero(0.0); };
  const std::int64_t at = std::llround(t_s / step_s);
  constexpr double before_s = 3.0;  // LOST came 0.6 to 2.7 s after slips of 20 cm, on one walk
  const std::int64_t earliest = at - std::llround(before_s / step_s);
  std::int64_t last = at;
  while (last > earliest && !slipping(last)) --last;
  if (!slipping(last)) return std::nullopt;
  std::int64_t first = last;
  while (slipping(first - 1)) --first;
  while (slipping(last + 1)) ++last;
  return SlipEpisode{static_cast<double>(first) * step_s, static_cast<double>(last + 1) * step_s};
}

}  // namespace plumbline::scenarios
