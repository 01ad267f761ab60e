// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "slam/localization/comparison_config.h"
#include "slam/plan_map/localization_scan.h"
#include "slam/plan_map/plan_index.h"

namespace plumbline::slam {

/// The plan is cast no farther than this beyond a return: the residual is at its cap there.
constexpr float cast_beyond_m = 2.0F;

/// What the plan's structure predicts for four beams.
struct PredictedBlock {
  Float4 expected = all(0.0F);    ///< horizontal range, m; where nothing is hit, how far was cast
  Float4 reciprocal = all(0.0F);  ///< of expected, 1/m
  Float4 incidence = all(1.0F);   ///< cosine at the face hit, at least min_incidence; 1 where no upright face is
  Mask4 element{-1, -1, -1, -1};  ///< with the upright face that is hit, -1: none
  Mask4 side{0, 0, 0, 0};         ///< eighth of a turn that the face's normal points to
};

/// What the plan predicts for each beam of LocalizationScan::beam_grid at one pose. In single precision: 0.01 mm in a
/// plan of 100 m.
struct PredictedScan {
  const StoreyIndex* storey = nullptr;
  Eigen::Matrix2d R_IH = Eigen::Matrix2d::Identity();
  Eigen::Vector2d sensor_I = Eigen::Vector2d::Zero();
  double floor_z = 0.0;                ///< in I, below the sensor
  int cell = -1;                       ///< of the storey's grid, with the sensor
  std::vector<PredictedBlock> blocks;  ///< as those of the beam grid
  mutable std::vector<Float4> cost;    ///< of the measured ranges, computed on first use; negative: not yet
};
[[nodiscard]] PredictedScan predict_scan(const StoreyIndex& storey, const Pose2& X_IH, const LocalizationScan& scan,
                                         const HypothesisComparisonConfig& config);

/// Negative log-likelihood of ranges where the plan predicts `hits`, each up to the cap of its sign. In beams.
[[nodiscard]] Float4 cost_of(Float4 range, const PredictedBlock& hits, const HypothesisComparisonConfig& config);

/// Cost of the beams of block i, each by the best prediction among it and its neighbours on the ring: a beam next to an
/// edge of the plan may hit either side of it.
[[nodiscard]] Float4 beam_cost(const LocalizationScan& scan, const PredictedScan& predicted, std::size_t i,
                               const HypothesisComparisonConfig& config);

/// Negative log-likelihood of a scan where the plan predicts this one, in beams.
[[nodiscard]] double total_cost(const LocalizationScan& scan, const PredictedScan& predicted,
                                const HypothesisComparisonConfig& config);

}  // namespace plumbline::slam
