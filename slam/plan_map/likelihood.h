// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/config/visit.h"
#include "slam/plan_map/localization_scan.h"
#include "slam/plan_map/plan_index.h"

namespace plumbline::slam {

struct LikelihoodConfig {
  double azimuth_sigma = 0.02;
  double distance_sigma_m = 0.05;
  double azimuth_gate = 0.45;
  double distance_gate_m = 5.0;
  double overlap_min = 0.5;
  double overlap_margin_m = 0.3;
  double plane_outlier = 0.2;
  double plane_weight = 0.5;

  double beam_sigma_m = 0.06;
  double beam_min_incidence = 0.2;
  double beam_max_nll_short = 2.0;
  double beam_max_nll_long = 4.5;
  double beam_weight = 0.15;

  template <class V>
  void visit(V& v) {
    v("azimuth_sigma", azimuth_sigma,
      Field{.doc = "standard deviation of a wall's azimuth, added to the fit's: body tilt, plan tolerance",
            .unit = "rad",
            .min = 1e-6});
    // Plan tolerance and the spacing of the particles.
    v("distance_sigma_m", distance_sigma_m,
      Field{.doc = "standard deviation of a wall's distance, added to the fit's", .min = 1e-6});
    v("azimuth_gate", azimuth_gate,
      Field{.doc = "largest angle between an observed wall and the faces it is compared with",
            .unit = "rad",
            .min = 1e-6});
    v("distance_gate_m", distance_gate_m,
      Field{.doc = "half width of the residual volume over which an outlier is spread", .min = 1e-6});
    v("overlap_min", overlap_min, share_field("least share of the observed patch that lies on the face"));
    v("overlap_margin_m", overlap_margin_m,
      Field{.doc = "length by which a face is extended for this overlap", .min = 0});
    v("plane_outlier", plane_outlier,
      plain_field("share of patches that are no wall of the plan", {.min = 1e-6, .max = 1}));
    v("plane_weight", plane_weight,
      plain_field("weight of a patch: patches of one scan have correlated errors", {.min = 0}));
    v("beam_sigma_m", beam_sigma_m,
      Field{.doc = "standard deviation across the face: range noise, bias and plan tolerance", .min = 1e-6});
    v("beam_min_incidence", beam_min_incidence,
      share_field("cosine of incidence below which a beam's residual no longer shrinks"));
    v("beam_max_nll_short", beam_max_nll_short,
      plain_field("largest negative log-likelihood of a beam cut short, as clutter does",
                  {.min = 0, .former = "beam_short_cap"}));
    // 3 standard deviations.
    v("beam_max_nll_long", beam_max_nll_long,
      plain_field("largest negative log-likelihood of a beam that penetrates a wall of the plan",
                  {.min = 0, .former = "beam_long_cap"}));
    v("beam_weight", beam_weight,
      plain_field("weight of one beam: neighbouring beams have correlated errors", {.min = 0}));
  }
};

/// Where the sensor stands when the robot is at a pose; frame I.
struct SensorPose2 {
  Pose2 X_IH;
  Eigen::Matrix2d R_IH;
  Eigen::Vector2d sensor_I;
  int cell = -1;  ///< of StoreyIndex::grid, with the sensor

  SensorPose2(const StoreyIndex& storey, const Pose2& X, const LocalizationScan& scan)
      : X_IH(X), R_IH(X.rotation()), sensor_I(R_IH * scan.sensor_H + X.t), cell(storey.grid.cell_at(sensor_I)) {}
};

/// Inverse variances of an observed wall's residual.
struct WallInformation {
  double azimuth = 0.0, distance = 0.0;
};
[[nodiscard]] WallInformation information(const WallObservation& wall, const LikelihoodConfig& config);
/// Density of a residual of zero, of a wall of the plan.
[[nodiscard]] double peak_density(const WallInformation& v, const LikelihoodConfig& config);

/// log p(beams | pose) of every stride-th beam against first hits in the plan.
[[nodiscard]] double beam_log_likelihood(const StoreyIndex& storey, const Pose2& X_IH, const LocalizationScan& scan,
                                         int stride, const LikelihoodConfig& config);

/// Horizontal range up to which faces are evidence about a beam: floor, ceiling, or 1 m behind its return.
[[nodiscard]] double beam_reach(const StoreyIndex& storey, const Beam& beam, double sensor_height);

/// One beam against the plan.
struct BeamResidual {
  double across = 0.0;    ///< measured minus expected range, across the face hit, m; positive: through the wall
  int segment = -1;       ///< -1: floor, ceiling or nothing
  double expected = 0.0;  ///< horizontal range
};
/// cell: of storey.grid, with the sensor.
[[nodiscard]] BeamResidual beam_residual(const StoreyIndex& storey, const Eigen::Vector2d& sensor_I, int cell,
                                         const Eigen::Matrix2d& R_IH, const Beam& beam, double sensor_height,
                                         const LikelihoodConfig& config);

}  // namespace plumbline::slam
