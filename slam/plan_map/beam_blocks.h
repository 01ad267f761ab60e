// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "slam/plan_map/float4.h"
#include "slam/plan_map/likelihood.h"

namespace plumbline::slam {

/// Every stride-th beam of a scan, four of neighbouring direction side by side, for many poses on one storey. In single
/// precision: 0.01 mm in a plan of 100 m.
class BeamBlocks {
 public:
  /// Keeps references to storey, scan and config.
  BeamBlocks(const StoreyIndex& storey, const LocalizationScan& scan, int stride, const LikelihoodConfig& config);

  /// As beam_log_likelihood, but for rounding; a beam that grazes an edge may go to its other side.
  [[nodiscard]] double log_likelihood(const SensorPose2& pose) const;

 private:
  struct Block {
    Float4 x, y;                         ///< unit directions in H
    Float4 range;                        ///< horizontal, m
    Float4 reach;                        ///< farther faces change nothing; less than 0 where there is no beam
    Float4 enough;                       ///< a face hit here or sooner: nearer ones change nothing
    Float4 slope;                        ///< rise per horizontal metre
    double from = 0.0, span = 0.0;       ///< azimuths, in sectors of FaceSectors
    std::array<std::size_t, 4> beams{};  ///< of the scan
  };
  struct Sensor;
  struct Hits;
  [[nodiscard]] Hits cast(const Block& block, const Sensor& sensor) const;
  /// Casts beam k by itself, where the tables do not reach far enough.
  void cast_one(const Block& block, const Sensor& sensor, std::size_t k, Hits& hits) const;
  [[nodiscard]] Float4 penalty(const Block& block, const Hits& hits) const;

  const StoreyIndex& storey_;
  const LocalizationScan& scan_;
  int stride_;
  const LikelihoodConfig& config_;
  Float4 least_incidence_, inverse_sigma_, long_cap_, short_cap_;  ///< of config
  std::vector<Block> blocks_;
};

}  // namespace plumbline::slam
