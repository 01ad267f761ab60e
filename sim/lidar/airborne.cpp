// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/airborne.h"

#include <cmath>

namespace plumbline::sim {

namespace {

constexpr std::uint8_t reflectivity_byte = 5;  ///< particles give back little

}  // namespace

Airborne::Airborne(const LidarConfig& config, Seed seed)
    : density_per_m_(config.airborne_per_m),
      reach_m_(config.airborne_reach_m),
      model_(slam::lidar_model(config.model)),
      stream_(seed, "sim.lidar.airborne") {}

std::optional<double> Airborne::at(std::int64_t firing, std::size_t laser) const {
  const double u = stream_.uniform(static_cast<std::uint64_t>(firing), static_cast<std::uint32_t>(laser));
  const double range_m = model_.range_min_m - std::log(1.0 - u) / density_per_m_;
  if (range_m > reach_m_) return std::nullopt;
  return range_m;
}

slam::ReturnWord Airborne::word(double range_m) const {
  return {static_cast<std::uint32_t>(std::lround(range_m / model_.range_unit_m)), reflectivity_byte};
}

}  // namespace plumbline::sim
