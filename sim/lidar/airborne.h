// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "bim/random/stream.h"
#include "sim/lidar/lidar_config.h"
#include "slam/io/packets/vlp16.h"

namespace plumbline::sim {

/// Dust or rain, evenly spread: the share of beams that it gives back between the least range and R is
/// 1 - exp(-density (R - least range)). Draws are addressed by firing and laser.
class Airborne {
 public:
  Airborne(const LidarConfig& config, Seed seed);

  /// Range of the first particle that a beam meets, m; none within reach.
  [[nodiscard]] std::optional<double> at(std::int64_t firing, std::size_t laser) const;
  /// Its return.
  [[nodiscard]] slam::ReturnWord word(double range_m) const;

 private:
  double density_per_m_;
  double reach_m_;
  const slam::LidarModel& model_;
  Stream stream_;
};

}  // namespace plumbline::sim
