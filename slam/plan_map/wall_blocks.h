// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "slam/plan_map/float4.h"
#include "slam/plan_map/likelihood.h"

namespace plumbline::slam {

/// The walls of a scan, four side by side, for many poses. In single precision.
class WallBlocks {
 public:
  /// Keeps a reference to config.
  WallBlocks(const LocalizationScan& scan, const LikelihoodConfig& config);

  /// log p(walls | pose): each observed wall is a mixture of the best face of the plan and an outlier, so that every
  /// observation counts [shaheer2023, eq. 6-9, corrected]. Frame I; pose is that of H. In single precision, so a wall
  /// at the edge of a gate may fall on its other side.
  [[nodiscard]] double log_likelihood(const StoreyIndex& storey, const SensorPose2& pose) const;

 private:
  struct Block {
    Float4 azimuth, distance, s0, s1;                  ///< as in WallObservation
    Float4 least_overlap;                              ///< m
    Float4 azimuth_information, distance_information;  ///< inverse variances
    Float4 peak, outlier;                              ///< densities; 0 and 1 where there is no wall
  };

  const LikelihoodConfig& config_;
  std::vector<Block> blocks_;
};

}  // namespace plumbline::slam
