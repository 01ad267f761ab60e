// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "slam/plan_map/float4.h"
#include "slam/plan_map/likelihood.h"

namespace plumbline::slam {

/// The walls of a view, four side by side, for many poses. In single precision.
class WallBlocks {
 public:
  /// Keeps a reference to config.
  WallBlocks(const View& view, const LikelihoodConfig& config);

  /// As wall_log_likelihood, but for rounding; a wall at the edge of a gate may go to its other side.
  [[nodiscard]] double log_likelihood(const StoreyIndex& storey, const Stand& stand) const;

 private:
  struct Block {
    Float4 azimuth, distance, s0, s1;                  ///< as in WallView
    Float4 least_overlap;                              ///< m
    Float4 azimuth_information, distance_information;  ///< inverse variances
    Float4 peak, outlier;                              ///< densities; 0 and 1 where there is no wall
  };

  const LikelihoodConfig& config_;
  std::vector<Block> blocks_;
};

}  // namespace plumbline::slam
