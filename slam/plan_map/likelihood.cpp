// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/likelihood.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace plumbline::slam {

namespace {

constexpr double pi = std::numbers::pi;

/// Difference of two angles in (-pi, pi].
double difference(double a, double b) {
  const double d = a - b;
  return d > pi ? d - 2.0 * pi : d <= -pi ? d + 2.0 * pi : d;
}

/// A line of the plan as the sensor at one pose would see it.
struct ExpectedWall {
  double azimuth_H, distance, foot, length;
};

/// Squared Mahalanobis distance of an observed wall to an expected one, infinity where it does not fit.
double mismatch(const WallView& wall, const ExpectedWall& expected, const WallInformation& v,
                const LikelihoodConfig& config) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double e_azimuth = difference(wall.azimuth, expected.azimuth_H);
  if (std::abs(e_azimuth) > config.azimuth_gate) return infinity;
  const double margin = config.overlap_margin_m;
  const double overlap =
      std::min(expected.foot + wall.s1, expected.length + margin) - std::max(expected.foot + wall.s0, -margin);
  if (overlap < config.overlap_min * (wall.s1 - wall.s0)) return infinity;
  const double e_distance = wall.distance - expected.distance;
  return e_azimuth * e_azimuth * v.azimuth + e_distance * e_distance * v.distance;
}

/// Smallest mismatch of each observed wall over the lines seen from the sensor's cell.
std::array<double, max_walls> best_mismatch(const StoreyIndex& storey, const Pose2& X_IH, const View& view,
                                            const LikelihoodConfig& config) {
  std::array<double, max_walls> best;
  best.fill(std::numeric_limits<double>::infinity());
  const Eigen::Vector2d sensor_I = X_IH * view.sensor_H;
  const int cell = storey.grid.cell_at(sensor_I);
  if (cell < 0) return best;
  for (const int i : storey.visible[static_cast<std::size_t>(cell)]) {
    const WallLine& line = storey.lines[static_cast<std::size_t>(i)];
    const ExpectedWall expected{difference(line.azimuth, X_IH.yaw), line.n.dot(sensor_I) + line.d,
                                line.e.dot(sensor_I - line.a), line.length};
    if (expected.distance <= 0.0) continue;
    for (std::size_t k = 0; k < view.walls.size(); ++k)
      best[k] = std::min(best[k], mismatch(view.walls[k], expected, information(view.walls[k], config), config));
  }
  return best;
}

}  // namespace

WallInformation information(const WallView& wall, const LikelihoodConfig& config) {
  return {1.0 / (wall.sigma_azimuth * wall.sigma_azimuth + config.azimuth_sigma * config.azimuth_sigma),
          1.0 / (wall.sigma_distance * wall.sigma_distance + config.distance_sigma_m * config.distance_sigma_m)};
}

double peak_density(const WallInformation& v, const LikelihoodConfig& config) {
  return (1.0 - config.plane_outlier) / (2.0 * pi) * std::sqrt(v.azimuth * v.distance);
}

double wall_log_likelihood(const StoreyIndex& storey, const Pose2& X_IH, const View& view,
                           const LikelihoodConfig& config) {
  const std::array<double, max_walls> best = best_mismatch(storey, X_IH, view, config);
  const double outlier = config.plane_outlier / (4.0 * config.azimuth_gate * config.distance_gate_m);
  // One logarithm of a product, taken before it could leave the range of a double.
  double sum = 0.0, product = 1.0;
  for (std::size_t k = 0; k < view.walls.size(); ++k) {
    const double peak = peak_density(information(view.walls[k], config), config);
    product *= outlier + (best[k] < 100.0 ? peak * std::exp(-0.5 * best[k]) : 0.0);
    if (product > 1e-200 && product < 1e200) continue;
    sum += std::log(product);
    product = 1.0;
  }
  sum += std::log(product);
  return config.plane_weight * sum;
}

double beam_reach(const StoreyIndex& storey, const Beam& beam, double sensor_height) {
  // Beyond this the beam has long gone through a wall; farther faces change nothing.
  const double reach = beam.range + 1.0;
  // Floor and ceiling are divided for only where the beam comes near them.
  const double z = storey.floor_z + sensor_height, end = 1.001 * reach * beam.slope,
               limit = beam.slope < 0.0 ? -sensor_height : storey.ceiling_z - z;
  if (beam.slope < 0.0 ? end < limit : beam.slope > 0.0 && end > limit)
    return std::clamp(limit / beam.slope, 0.0, reach);
  return reach;
}

BeamResidual beam_residual(const StoreyIndex& storey, const Eigen::Vector2d& sensor_I, int cell,
                           const Eigen::Matrix2d& R_IH, const Beam& beam, double sensor_height,
                           const LikelihoodConfig& config) {
  const PlanRay ray{sensor_I, R_IH * beam.direction_H, storey.floor_z + sensor_height, beam.slope};
  const PlanHit hit = storey.grid.cast(storey.segments, ray, beam_reach(storey, beam, sensor_height), cell);
  BeamResidual residual{beam.range - hit.distance, hit.segment, hit.distance};
  if (hit.segment >= 0) {
    const double incidence = std::abs(storey.segments[static_cast<std::size_t>(hit.segment)].n.dot(ray.direction));
    residual.across *= std::max(incidence, config.beam_min_incidence);
  }
  return residual;
}

double beam_log_likelihood(const StoreyIndex& storey, const Pose2& X_IH, const View& view, int stride,
                           const LikelihoodConfig& config) {
  const Eigen::Matrix2d R_IH = X_IH.rotation();
  const Eigen::Vector2d sensor_I = R_IH * view.sensor_H + X_IH.t;
  const int cell = storey.grid.cell_at(sensor_I);
  const double inverse_sigma = 1.0 / config.beam_sigma_m;
  double sum = 0.0;
  for (std::size_t i = 0; i < view.beams.size(); i += static_cast<std::size_t>(stride)) {
    const double e =
        inverse_sigma * beam_residual(storey, sensor_I, cell, R_IH, view.beams[i], view.sensor_height, config).across;
    sum -= std::min(0.5 * e * e, e > 0.0 ? config.beam_long_cap : config.beam_short_cap);
  }
  return config.beam_weight * stride * sum;
}

}  // namespace plumbline::slam
