// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "bim/random/stream.h"
#include "sim/lidar/lidar_config.h"
#include "slam/io/packets/vlp16.h"

namespace plumbline::sim {

/// Detector model of one unit: dropouts, range noise, biases and systematic range errors. Every draw is addressed by
/// firing, laser and the echo's rank alone, so that none moves another.
class Detector {
 public:
  /// Draws the unit's biases, the same for all parts of a run.
  Detector(const LidarConfig& config, Seed seed);

  /// The echo of this rank (0 the nearest), or distance 0 where nothing is detected. strength: reflectivity of what
  /// the echo comes from, above 1 for a retro-reflector.
  [[nodiscard]] slam::ReturnWord measure(std::int64_t firing, std::size_t laser, std::uint32_t rank, double range_m,
                                         double strength, double cosine) const;

 private:
  LidarConfig config_;
  const slam::LidarModel& model_;
  Stream dropout_;
  Stream range_;
  Stream reflectivity_;
  std::vector<double> bias_m_;  ///< by laser
};

}  // namespace plumbline::sim
