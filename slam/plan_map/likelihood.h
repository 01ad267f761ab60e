// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/config/visit.h"
#include "slam/plan_map/localization_scan.h"
#include "slam/plan_map/plan_index.h"

namespace plumbline::slam {

struct LikelihoodConfig {
  double azimuth_sigma = 0.02;     ///< rad: tilt of the walking body, plan tolerance; added to the fit's
  double distance_sigma_m = 0.05;  ///< plan tolerance and the spacing of particles; added to the fit's
  double azimuth_gate = 0.45;      ///< rad: an observed wall is compared with faces this close in direction
  double distance_gate_m = 5.0;    ///< half width of the residual volume over which an outlier is spread
  double overlap_min = 0.5;        ///< share of the patch that must lie on the face
  double overlap_margin_m = 0.3;   ///< by which a face is lengthened for that
  double plane_outlier = 0.2;      ///< share of patches that are no wall of the plan
  double plane_weight = 0.5;       ///< patches of one scan share their errors: not all evidence is new

  double beam_sigma_m = 0.06;       ///< range noise, bias and plan tolerance, across the face
  double beam_min_incidence = 0.2;  ///< cosine below which a grazing beam's residual no longer shrinks
  double beam_short_cap = 2.0;      ///< of the negative log-likelihood of a beam cut short: clutter does that
  double beam_long_cap = 4.5;       ///< of one that goes through a wall of the plan, 3 sigma
  double beam_weight = 0.15;        ///< of one beam; neighbouring beams share their errors [facts: 8 by 360 / 8]

  template <class V>
  void visit(V& v) {
    v("azimuth_sigma", azimuth_sigma,
      Field{.doc = "rad: tilt of the walking body, plan tolerance; added to the fit's", .min = 1e-6});
    v("distance_sigma_m", distance_sigma_m,
      Field{.doc = "plan tolerance and the spacing of particles; added to the fit's", .min = 1e-6});
    v("azimuth_gate", azimuth_gate,
      Field{.doc = "rad: an observed wall is compared with faces this close in direction", .min = 1e-6});
    v("distance_gate_m", distance_gate_m,
      Field{.doc = "half width of the residual volume over which an outlier is spread", .min = 1e-6});
    v("overlap_min", overlap_min, Field{.doc = "share of the patch that must lie on the face", .min = 0, .max = 1});
    v("overlap_margin_m", overlap_margin_m, Field{.doc = "by which a face is lengthened for that", .min = 0});
    v("plane_outlier", plane_outlier,
      Field{.doc = "share of patches that are no wall of the plan", .min = 0, .max = 1});
    v("plane_weight", plane_weight,
      Field{.doc = "patches of one scan share their errors: not all evidence is new", .min = 0});
    v("beam_sigma_m", beam_sigma_m, Field{.doc = "range noise, bias and plan tolerance, across the face", .min = 1e-6});
    v("beam_min_incidence", beam_min_incidence,
      Field{.doc = "cosine below which a grazing beam's residual no longer shrinks", .min = 0, .max = 1});
    v("beam_short_cap", beam_short_cap,
      Field{.doc = "of the negative log-likelihood of a beam cut short: clutter does that", .min = 0});
    v("beam_long_cap", beam_long_cap, Field{.doc = "of one that goes through a wall of the plan, 3 sigma", .min = 0});
    v("beam_weight", beam_weight, Field{.doc = "of one beam; neighbouring beams share their errors", .min = 0});
  }
};

/// Where the sensor stands when the robot is at a pose; frame I.
struct Stand {
  Pose2 X_IH;
  Eigen::Matrix2d R_IH;
  Eigen::Vector2d sensor_I;
  int cell = -1;  ///< of StoreyIndex::grid, with the sensor

  Stand(const StoreyIndex& storey, const Pose2& X, const View& view)
      : X_IH(X), R_IH(X.rotation()), sensor_I(R_IH * view.sensor_H + X.t), cell(storey.grid.cell_at(sensor_I)) {}
};

/// Inverse variances of an observed wall's residual.
struct WallInformation {
  double azimuth = 0.0, distance = 0.0;
};
[[nodiscard]] WallInformation information(const WallView& wall, const LikelihoodConfig& config);
/// Density of a residual of zero, of a wall of the plan.
[[nodiscard]] double peak_density(const WallInformation& v, const LikelihoodConfig& config);

/// log p(walls | pose): each observed wall is a mixture of the best face of the plan and an outlier, so that every
/// observation counts [BIM-Loc eq. 6-9, corrected]. Frame I; pose is that of H.
[[nodiscard]] double wall_log_likelihood(const StoreyIndex& storey, const Pose2& X_IH, const View& view,
                                         const LikelihoodConfig& config);

/// log p(beams | pose) of every stride-th beam against first hits in the plan.
[[nodiscard]] double beam_log_likelihood(const StoreyIndex& storey, const Pose2& X_IH, const View& view, int stride,
                                         const LikelihoodConfig& config);

/// Horizontal range up to which faces say something about a beam: floor, ceiling, or 1 m behind its return.
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
