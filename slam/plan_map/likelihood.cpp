// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/likelihood.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumbline::slam {

namespace {

constexpr double pi = std::numbers::pi;

}  // namespace

WallInformation information(const WallObservation& wall, const LikelihoodConfig& config) {
  return {1.0 / (wall.sigma_azimuth * wall.sigma_azimuth + config.azimuth_sigma * config.azimuth_sigma),
          1.0 / (wall.sigma_distance * wall.sigma_distance + config.distance_sigma_m * config.distance_sigma_m)};
}

double peak_density(const WallInformation& v, const LikelihoodConfig& config) {
  return (1.0 - config.plane_outlier) / (2.0 * pi) * std::sqrt(v.azimuth * v.distance);
}

double beam_reach(const StoreyIndex& storey, const Beam& beam, double sensor_height) {
  // Beyond this the beam has long gone through a wall; farther faces change nothing.
  const double reach = beam.range + 1.0;
  // Floor and ceiling are divided for only where the beam comes near them.
  const double z = storey.lowest_floor() + sensor_height, end = 1.001 * reach * beam.slope,
               limit = beam.slope < 0.0 ? -sensor_height : storey.ceiling_z - z;
  if (beam.slope < 0.0 ? end < limit : beam.slope > 0.0 && end > limit)
    return std::clamp(limit / beam.slope, 0.0, reach);
  return reach;
}

BeamResidual beam_residual(const StoreyIndex& storey, const Eigen::Vector2d& sensor_I, int cell,
                           const Eigen::Matrix2d& R_IH, const Beam& beam, double sensor_height,
                           const LikelihoodConfig& config) {
  const PlanRay ray{sensor_I, R_IH * beam.direction_H, storey.floor_at(sensor_I) + sensor_height, beam.slope};
  const PlanHit hit = storey.grid.cast(storey.segments, ray, beam_reach(storey, beam, sensor_height), cell);
  BeamResidual residual{beam.range - hit.distance, hit.segment, hit.distance};
  if (hit.segment >= 0) {
    const double incidence = std::abs(storey.segments[static_cast<std::size_t>(hit.segment)].n.dot(ray.direction));
    residual.across *= std::max(incidence, config.beam_min_incidence);
  }
  return residual;
}

double beam_log_likelihood(const StoreyIndex& storey, const Pose2& X_IH, const LocalizationScan& scan, int stride,
                           const LikelihoodConfig& config) {
  const Eigen::Matrix2d R_IH = X_IH.rotation();
  const Eigen::Vector2d sensor_I = R_IH * scan.sensor_H + X_IH.t;
  const int cell = storey.grid.cell_at(sensor_I);
  const double inverse_sigma = 1.0 / config.beam_sigma_m;
  double sum = 0.0;
  for (std::size_t i = 0; i < scan.beams.size(); i += static_cast<std::size_t>(stride)) {
    const double e =
        inverse_sigma * beam_residual(storey, sensor_I, cell, R_IH, scan.beams[i], scan.sensor_height, config).across;
    sum -= std::min(0.5 * e * e, e > 0.0 ? config.beam_max_nll_long : config.beam_max_nll_short);
  }
  return config.beam_weight * stride * sum;
}

}  // namespace plumbline::slam
