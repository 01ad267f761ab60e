// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "sim/clock_error.h"
#include "sim/mount_error.h"
#include "sim/robot/imu_error.h"
#include "sim/robot/slip.h"

namespace plumbline::sim {

/// none: what a robot's owner has calibrated is right. harsh: every error below, of the sizes of
/// docs/methods/robot.md.
enum class FaultsPreset { none, harsh };
[[nodiscard]] constexpr std::array<std::string_view, 2> names_of(FaultsPreset) { return {"none", "harsh"}; }

/// Errors of mount, time, IMU and feet that no estimator is told of.
struct Faults {
  ClockConfig clock;
  MountError mount;
  ImuError imu;
  SlipConfig slip;
};

[[nodiscard]] Faults faults_of(FaultsPreset preset);

}  // namespace plumbline::sim
