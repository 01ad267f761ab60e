// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/range_error.h"

#include <algorithm>
#include <cmath>

namespace plumbline::sim {

namespace {

constexpr double near_m = 2.4;  ///< distances of the two-point calibration
constexpr double far_m = 25.0;
constexpr double grey = 0.5;  ///< reflectivity without error
constexpr double decades_max = 2.0;
constexpr double incidence_m = 10.0;            ///< where incidence_bias_m holds
constexpr double incidence_tan = 5.6712818196;  ///< of 80 degrees
constexpr double cosine_min = 0.0871557427;     ///< 85 degrees; nothing is known beyond
constexpr double incidence_max_m = 20.0;

double distance_share(double range_m) { return std::clamp((far_m - range_m) / (far_m - near_m), 0.0, 1.0); }

double decades_below_grey(double reflectivity) {
  const double factor = std::pow(10.0, decades_max);
  return std::log10(grey / std::clamp(reflectivity, grey / factor, grey * factor));
}

/// Depth of the footprint on the surface, over that where incidence_bias_m holds.
double depth_ratio(double range_m, double cosine) {
  const double c = std::clamp(cosine, cosine_min, 1.0);
  return std::min(range_m, incidence_max_m) / incidence_m * std::sqrt(1.0 - c * c) / (c * incidence_tan);
}

}  // namespace

double range_error(const LidarConfig& config, double time_s, double range_m, double reflectivity, double cosine) {
  double error = 0.0;
  if (config.distance_bias_m != 0.0) error -= config.distance_bias_m * distance_share(range_m);
  if (config.reflectivity_bias_m != 0.0) error += config.reflectivity_bias_m * decades_below_grey(reflectivity);
  if (config.incidence_bias_m != 0.0) error -= config.incidence_bias_m * depth_ratio(range_m, cosine);
  if (config.warm_up_m != 0.0) error += config.warm_up_m * std::exp(-time_s / config.warm_up_s);
  return error;
}

}  // namespace plumbline::sim
