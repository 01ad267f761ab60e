// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/lidar_config.h"

namespace plumbline::sim {

LidarConfig lidar_config(LidarPreset preset) {
  LidarConfig config;
  if (preset == LidarPreset::full) config.footprint = Footprint::everywhere;
  if (preset == LidarPreset::harsh) {
    config.distance_bias_m = 0.02;
    config.reflectivity_bias_m = 0.01;
    config.incidence_bias_m = 0.03;
    config.warm_up_m = 0.015;
    config.airborne_per_m = 0.002;
  }
  if (preset != LidarPreset::ideal && preset != LidarPreset::datasheet) return config;
  config.range_noise = preset == LidarPreset::datasheet;
  if (config.range_noise) config.sigma.fill({0.0, 0.03});  // the data sheet's accuracy
  config.unit_bias = config.laser_bias = config.reflectivity_noise = config.dropout = config.optics = false;
  config.footprint = Footprint::none;
  return config;
}

double range_sigma(const LidarConfig& config, double range_m) {
  const auto& knots = config.sigma;
  if (range_m <= knots.front().range_m) return knots.front().sigma_m;
  for (std::size_t i = 1; i < knots.size(); ++i) {
    if (range_m > knots[i].range_m) continue;
    const double share = (range_m - knots[i - 1].range_m) / (knots[i].range_m - knots[i - 1].range_m);
    return knots[i - 1].sigma_m + share * (knots[i].sigma_m - knots[i - 1].sigma_m);
  }
  return knots.back().sigma_m;
}

double return_share(const LidarConfig& config, double range_m, double cosine, double reflectivity) {
  const double half2 = config.dropout_cosine_half * config.dropout_cosine_half;
  const double incidence = half2 == 0.0 ? 1.0 : cosine * cosine / (cosine * cosine + half2);
  double distance = 1.0;
  if (config.dropout_range_half_m > 0.0) {
    const double ratio = range_m / config.dropout_range_half_m;
    const double ratio2 = ratio * ratio * (0.5 / reflectivity);
    distance = 1.0 / (1.0 + ratio2 * ratio2);
  }
  return (1.0 - config.dropout_share) * incidence * distance;
}

}  // namespace plumbline::sim
