// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "sim/robot/robot.h"
#include "slam/io/records.h"

namespace plumbline::sim {

enum class OdometryPreset { ideal, noisy, uncorrected };

/// Noisy encoders, gyro, accelerometer and contact flags of one physics step.
struct SensorReading {
  Proprioception measured;
  std::array<bool, 4> contact{};
};

/// Adds the preset's noise; tick counts physics steps.
class ProprioceptiveSensors {
 public:
  ProprioceptiveSensors(OdometryPreset preset, std::uint64_t seed);
  [[nodiscard]] SensorReading read(const Proprioception& truth, std::int64_t tick);

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

/// Dead reckoning from readings alone [facts: legged section 10]: X_OR, starting at identity.
class LegOdometry {
 public:
  explicit LegOdometry(OdometryPreset preset);
  void update(const SensorReading& reading, double dt);
  [[nodiscard]] const Pose& X_OR() const { return X_OR_; }

 private:
  OdometryPreset preset_;
  Pose X_OR_;
  Eigen::Vector3d velocity_R_ = Eigen::Vector3d::Zero();
  std::array<double, 4> contact_time_{};
};

}  // namespace plumbline::sim
