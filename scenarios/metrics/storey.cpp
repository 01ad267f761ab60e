// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/storey.h"

#include <algorithm>
#include <cmath>

#include "sim/world.h"

namespace plumbline::scenarios::score {

double base_height_m() {
  const slam::Calibration calibration = sim::World::calibration();
  return calibration.sensor_height_m - calibration.X_RL.t.z();
}

int storey_of_base(const std::vector<bim::PlanStorey>& storeys, double z_W) {
  const auto off = [&](const bim::PlanStorey& storey) { return std::abs(z_W - base_height_m() - storey.elevation_m); };
  const auto nearest =
      std::min_element(storeys.begin(), storeys.end(), [&](const auto& a, const auto& b) { return off(a) < off(b); });
  return nearest == storeys.end() ? 0 : static_cast<int>(nearest - storeys.begin());
}

int storey_of_height(const std::vector<bim::PlanStorey>& storeys, double z_W) {
  int best = -1, lowest = 0;
  for (std::size_t i = 0; i < storeys.size(); ++i) {
    const double z = storeys[i].elevation_m;
    if (z < storeys[static_cast<std::size_t>(lowest)].elevation_m) lowest = static_cast<int>(i);
    if (z <= z_W && (best < 0 || z > storeys[static_cast<std::size_t>(best)].elevation_m)) best = static_cast<int>(i);
  }
  return best < 0 ? lowest : best;
}

std::optional<double> height_of_room(const slam::Estimate& estimate, const slam::RoomNode& room) {
  double sum = 0.0;
  int count = 0;
  for (const slam::PlaneNode& plane : estimate.planes) {
    if (std::find(room.planes.begin(), room.planes.end(), plane.id) == room.planes.end()) continue;
    sum += 0.5 * (plane.z0 + plane.z1);
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

}  // namespace plumbline::scenarios::score
