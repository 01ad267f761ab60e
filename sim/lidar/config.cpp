// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/config.h"

#include "bim/errors.h"

namespace plumbline::sim {

namespace {

LidarConfig without_noise() {
  LidarConfig config;
  config.sigma.fill({0.0, 0.0});
  config.unit_bias_sigma_m = 0.0;
  config.laser_bias_sigma_m = 0.0;
  config.dropout = 0.0;
  config.dropout_cosine_half = 0.0;
  config.dropout_range_half_m = 0.0;
  return config;
}

}  // namespace

LidarConfig lidar_config(LidarPreset preset) {
  switch (preset) {
    case LidarPreset::ideal:
      return without_noise();
    case LidarPreset::datasheet: {
      LidarConfig config = without_noise();
      config.sigma.fill({0.0, 0.03});
      return config;
    }
    case LidarPreset::real:
      return {};
    case LidarPreset::full:
      break;
  }
  throw InputError({}, "LiDAR preset 'full' is not in this version; 'ideal', 'datasheet' or 'real' would be right");
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

double return_share(const LidarConfig& config, double range_m, double cosine) {
  const double half2 = config.dropout_cosine_half * config.dropout_cosine_half;
  const double incidence = half2 == 0.0 ? 1.0 : cosine * cosine / (cosine * cosine + half2);
  double distance = 1.0;
  if (config.dropout_range_half_m > 0.0) {
    const double ratio = range_m / config.dropout_range_half_m;
    const double ratio2 = ratio * ratio * (0.5 / config.reflectivity);
    distance = 1.0 / (1.0 + ratio2 * ratio2);
  }
  return (1.0 - config.dropout) * incidence * distance;
}

}  // namespace plumbline::sim
