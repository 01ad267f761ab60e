// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace plumbline::sim {

/// ideal: packets and timing only. datasheet: the data sheet's accuracy taken as noise. real: as measured on two real
/// units. full: real with mixed pixels and glass, not in this version.
enum class LidarPreset { ideal, datasheet, real, full };

/// Standard deviation of a range at one distance; linear in between, constant beyond the ends.
struct RangeSigma {
  double range_m = 0.0;
  double sigma_m = 0.0;
};

/// What one unit measures. Defaults: preset real [facts: lidar section 2].
struct LidarConfig {
  double range_min_m = 0.4;    ///< nearer returns are lost [ROS driver's launch files]
  double range_max_m = 100.0;  ///< [manual]
  /// Repeatability on a static target [facts: lidar section 2.2, between the two units].
  std::array<RangeSigma, 4> sigma = {{{3.0, 0.006}, {5.0, 0.010}, {8.0, 0.015}, {40.0, 0.018}}};
  double unit_bias_sigma_m = 0.015;   ///< one draw a run, for all lasers [section 2.2: a unit was off by 30 mm]
  double laser_bias_sigma_m = 0.011;  ///< one draw a run and laser; makes walls 12-17 mm thick [section 2.5]
  double dropout = 0.04;              ///< share of returns lost whatever they hit
  /// Half of the returns are lost where the cosine of the incidence is this (share c^2 / (c^2 + half^2) returns) ...
  double dropout_cosine_half = 0.07;
  /// ... and at this range on a surface of reflectivity 0.5 (1 / (1 + (r / half)^4) returns); 80-95 % of the beams
  /// that hit a building's surface return [section 2.3].
  double dropout_range_half_m = 60.0;
  double reflectivity = 0.5;  ///< of every surface, diffuse, 0-1; no materials in this version
};

/// Throws InputError for `full`.
[[nodiscard]] LidarConfig lidar_config(LidarPreset preset);

/// Standard deviation of a range, m.
[[nodiscard]] double range_sigma(const LidarConfig& config, double range_m);
/// Share of beams that return from a surface at this range and cosine of the angle of incidence.
[[nodiscard]] double return_share(const LidarConfig& config, double range_m, double cosine);

}  // namespace plumbline::sim
