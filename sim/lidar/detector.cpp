// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/detector.h"

#include <algorithm>
#include <cmath>

#include "sim/lidar/range_error.h"

namespace plumbline::sim {

namespace {

/// As the manual calibrates it: 0-100 for diffuse surfaces, above for retro-reflectors, whatever the range.
double calibrated_reflectivity(double strength, double cosine) {
  const double diffuse = std::min(100.0, 100.0 * strength * cosine);
  const double retro = strength <= 1.0 ? 0.0 : std::min(155.0, 100.0 * std::log10(strength));
  return diffuse + retro;
}

}  // namespace

Detector::Detector(const LidarConfig& config, Seed seed)
    : config_(config),
      model_(slam::lidar_model(config.model)),
      dropout_(seed, "sim.lidar.dropout"),
      range_(seed, "sim.lidar.range"),
      reflectivity_(seed, "sim.lidar.reflectivity") {
  const Stream bias(seed.run, "sim.lidar.bias");
  for (std::size_t k = 0; k < model_.lasers.size(); ++k)
    bias_m_.push_back(
        (config.unit_bias ? config.unit_bias_sigma_m * bias.gauss(0, 0) : 0.0) +
        (config.laser_bias ? config.laser_bias_sigma_m * bias.gauss(0, 1 + static_cast<std::uint32_t>(k)) : 0.0));
}

slam::ReturnWord Detector::measure(std::int64_t firing, std::size_t laser, std::uint32_t rank, double range_m,
                                   double strength, double cosine) const {
  const auto tick = static_cast<std::uint64_t>(firing);
  const auto lane = static_cast<std::uint32_t>(laser);
  if (config_.dropout && dropout_.uniform(tick, lane, rank) >= return_share(config_, range_m, cosine, strength))
    return {};
  const double noise = config_.range_noise ? range_sigma(config_, range_m) * range_.gauss(tick, lane, rank) : 0.0;
  const double time_s = config_.running_s + 1e-9 * static_cast<double>(firing * model_.firing_period_ns);
  const double range = range_m + bias_m_[laser] + noise + range_error(config_, time_s, range_m, strength, cosine);
  if (range < model_.range_min_m || range > model_.range_max_m) return {};
  double reflectivity = calibrated_reflectivity(strength, cosine);
  if (config_.reflectivity_noise)
    reflectivity += (config_.reflectivity_sigma + config_.reflectivity_sigma_share * reflectivity) *
                    reflectivity_.gauss(tick, lane, rank);
  return {static_cast<std::uint32_t>(std::lround(range / model_.range_unit_m)),
          static_cast<std::uint8_t>(std::lround(std::clamp(reflectivity, 0.0, 255.0)))};
}

}  // namespace plumbline::sim
