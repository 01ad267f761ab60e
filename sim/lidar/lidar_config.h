// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "slam/io/lidar_model.h"

namespace plumbline::sim {

/// ideal: packets and timing only. datasheet: the data sheet's accuracy taken as noise. real: as measured on two real
/// units, with the beam's footprint where it meets an edge. full: real with the footprint of every beam. harsh: real
/// with range errors that no estimator solves for, and with dust.
enum class LidarPreset { ideal, datasheet, real, full, harsh };
[[nodiscard]] constexpr std::array<std::string_view, 5> names_of(LidarPreset) {
  return {"ideal", "datasheet", "real", "full", "harsh"};
}

/// Where a beam is a bundle of sub-rays: nowhere, where it or a neighbour of its ring meets another face or a jump in
/// range, or everywhere.
enum class Footprint { none, edges, everywhere };
[[nodiscard]] constexpr std::array<std::string_view, 3> names_of(Footprint) { return {"none", "edges", "everywhere"}; }

/// Standard deviation of a range at one distance; linear in between, constant beyond the ends.
struct RangeSigma {
  double range_m = 0.0;
  double sigma_m = 0.0;
};

/// What one unit measures. Defaults: preset real, docs/methods/lidar_model.md.
struct LidarConfig {
  slam::LidarModelId model = slam::LidarModelId::vlp16;
  slam::ReturnMode returns = slam::ReturnMode::strongest;

  bool range_noise = true;
  bool unit_bias = true;
  bool laser_bias = true;
  bool reflectivity_noise = true;
  bool dropout = true;
  bool optics = true;  ///< panes let light through, polished surfaces mirror it; off: panes are not there
  Footprint footprint = Footprint::edges;

  /// Repeatability on a static target, between the two units of docs/methods/lidar_model.md.
  std::array<RangeSigma, 4> sigma = {{{3.0, 0.006}, {5.0, 0.010}, {8.0, 0.015}, {40.0, 0.018}}};
  double unit_bias_sigma_m = 0.015;    ///< one draw a run, for all lasers (a real unit was off by 30 mm)
  double laser_bias_sigma_m = 0.0135;  ///< one draw a run and laser; makes walls 12-17 mm thick

  /// Standard deviation of a reflectivity byte: a constant and a share of it, measured on neighbouring returns of a
  /// VLP-16 capture (0.6 at 5, 1.2 at 25, 1.8 at 55, 3.6 at 90).
  double reflectivity_sigma = 0.5;
  double reflectivity_sigma_share = 0.03;

  double dropout_share = 0.04;  ///< share of returns lost whatever they hit
  /// Half of the returns are lost where the cosine of the incidence is this (share c^2 / (c^2 + half^2) returns) ...
  double dropout_cosine_half = 0.07;
  /// ... and at this range on a surface of reflectivity 0.5 (1 / (1 + (r / half)^4) returns); 80-95 % of the beams
  /// that hit a building's surface return.
  double dropout_range_half_m = 60.0;
  double reflectivity = 0.5;  ///< of surfaces whose material is not known, diffuse, 0-1

  double divergence_horizontal_rad = 0.003;  ///< full angle [velodyne2018c, page 115]; none published for the VLP-16
  double divergence_vertical_rad = 0.0015;
  double edge_jump_m = 0.1;        ///< between neighbours of a ring: an edge
  double echo_separation_m = 1.0;  ///< nearer surfaces in one beam give one echo between them [velodyne2018c]
  double glint_rad = 0.01;         ///< a polished surface this close to square shines back as a retro-reflector

  /// Systematic range errors, m, see range_error(); 0: none.
  double distance_bias_m = 0.0;      ///< too short up to 2.4 m, less beyond, 0 from 25 m on
  double reflectivity_bias_m = 0.0;  ///< too long for each decade below a reflectivity of 0.5, too short above
  double incidence_bias_m = 0.0;     ///< too short at 10 m and 80 degrees, by the depth of the footprint elsewhere
  double warm_up_m = 0.0;            ///< too long when the sensor is switched on
  double warm_up_s = 300.0;          ///< until 1/e of that is left
  double running_s = 0.0;            ///< since the sensor was switched on, at firing 0

  double airborne_per_m = 0.0;     ///< share of beams that dust or rain gives back early, per metre; 0: clear air
  double airborne_reach_m = 15.0;  ///< farther particles give too little light
};

[[nodiscard]] LidarConfig lidar_config(LidarPreset preset);

/// Standard deviation of a range, m.
[[nodiscard]] double range_sigma(const LidarConfig& config, double range_m);
/// Share of beams that return from a surface of this reflectivity at this range and cosine of the angle of incidence.
[[nodiscard]] double return_share(const LidarConfig& config, double range_m, double cosine, double reflectivity);

}  // namespace plumbline::sim
