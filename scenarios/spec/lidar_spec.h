// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "bim/config/visit.h"
#include "sim/lidar/lidar.h"

namespace plumbline::scenarios {

/// The sensor. A switch that is not given is as the preset has it.
struct LidarSpec {
  slam::LidarModelId model = slam::LidarModelId::vlp16;
  sim::LidarPreset preset = sim::LidarPreset::real;
  slam::ReturnMode returns = slam::ReturnMode::strongest;
  double rpm = 600.0;
  bool vertical_offsets = true;
  std::optional<bool> range_noise;
  std::optional<bool> unit_bias;
  std::optional<bool> laser_bias;
  std::optional<bool> reflectivity_noise;
  std::optional<bool> dropout;
  std::optional<bool> optics;
  std::optional<sim::Footprint> footprint;
  std::optional<double> distance_bias_m;
  std::optional<double> reflectivity_bias_m;
  std::optional<double> incidence_bias_m;
  std::optional<double> warm_up_m;
  std::optional<double> warm_up_s;
  std::optional<double> airborne_per_m;
  template <class V>
  void visit(V& v) {
    v("model", model, Field{.doc = "sensor model"});
    v("preset", preset, Field{.doc = "preset of the noise; real: as measured on real units"});
    v("returns", returns, Field{.doc = "return mode: the strongest echo of a beam, the last, or both (dual)"});
    v("rpm", rpm, Field{.doc = "rotation rate", .unit = "rev/min", .min = 300.0, .max = 1200.0});
    v("vertical_offsets", vertical_offsets,
      Field{.doc = "whether the driver corrects for the different origins of the lasers"});
    v("range_noise", range_noise, Field{.doc = "noise of each range; the preset's when not given"});
    v("unit_bias", unit_bias, Field{.doc = "one range bias of the unit; the preset's when not given"});
    v("laser_bias", laser_bias, Field{.doc = "one range bias of each laser; the preset's when not given"});
    v("reflectivity_noise", reflectivity_noise,
      Field{.doc = "noise of each reflectivity; the preset's when not given"});
    v("dropout", dropout, Field{.doc = "random loss of returns; the preset's when not given"});
    v("optics", optics,
      Field{
          .doc =
              "transmission and mirror reflection; false: the LiDAR does not see glass; the preset's when not given"});
    v("footprint", footprint, Field{.doc = "where a beam has a width; the preset's when not given"});
    v("distance_bias_m", distance_bias_m,
      Field{.doc =
                "how much too short ranges up to 2.4 m are; less beyond, nothing from 25 m on; the preset's when not "
                "given",
            .min = -1.0,
            .max = 1.0});
    v("reflectivity_bias_m", reflectivity_bias_m,
      Field{.doc = "how much too long a range is for each decade of reflectivity below 0.5, and too short above; the "
                   "preset's when not given",
            .min = -1.0,
            .max = 1.0});
    v("incidence_bias_m", incidence_bias_m,
      Field{.doc =
                "how much too short a range is at 10 m and 80° of incidence, elsewhere by the depth of the footprint "
                "on the surface; the preset's when not given",
            .min = -1.0,
            .max = 1.0});
    v("warm_up_m", warm_up_m,
      Field{.doc = "how much too long ranges are when the sensor is switched on, at the start; the preset's when not "
                   "given",
            .min = -1.0,
            .max = 1.0});
    v("warm_up_s", warm_up_s,
      Field{.doc = "time until 1/e of that error is left; the preset's when not given", .min = 1.0, .max = 36000.0});
    v("airborne_per_m", airborne_per_m,
      Field{.doc = "share of the beams that dust or rain gives back early, for each metre of their way; the preset's "
                   "when not given",
            .unit = "1/m",
            .min = 0.0,
            .max = 1.0});
  }
};

/// The preset with the switches that are given.
[[nodiscard]] sim::LidarConfig lidar_config(const LidarSpec& spec);

}  // namespace plumbline::scenarios
