// SPDX-License-Identifier: Apache-2.0
#include "sim/faults.h"

#include <numbers>

namespace plumbline::sim {

Faults faults_of(FaultsPreset preset) {
  Faults faults;
  if (preset == FaultsPreset::none) return faults;
  faults.clock = {0.010, 0.002};
  faults.mount.length_m = 0.01;
  faults.mount.angle_rad = 0.5 * std::numbers::pi / 180.0;
  faults.imu = {2.6e-3, 0.02, 0.003};
  faults.slip.speed_mps = 0.3;
  return faults;
}

}  // namespace plumbline::sim
