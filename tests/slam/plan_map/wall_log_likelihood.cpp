// SPDX-License-Identifier: Apache-2.0
#include "tests/slam/plan_map/wall_log_likelihood.h"

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
double mismatch(const WallObservation& wall, const ExpectedWall& expected, const WallInformation& v,
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
std::array<double, max_walls> best_mismatch(const StoreyIndex& storey, const Pose2& X_IH, const LocalizationScan& scan,
                                            const LikelihoodConfig& config) {
  std::array<double, max_walls> best;
  best.fill(std::numeric_limits<double>::infinity());
  const Eigen::Vector2d sensor_I = X_IH * scan.sensor_H;
  const int cell = storey.grid.cell_at(sensor_I);
  if (cell < 0) return best;
  for (const int i : storey.visible[static_cast<std::size_t>(cell)]) {
    const WallLine& line = storey.lines[static_cast<std::size_t>(i)];
    const ExpectedWall expected{difference(line.azimuth, X_IH.yaw), line.n.dot(sensor_I) + line.d,
                                line.e.dot(sensor_I - line.a), line.length};
    if (expected.distance <= 0.0) continue;
    for (std::size_t k = 0; k < scan.walls.size(); ++k)
      best[k] = std::min(best[k], mismatch(scan.walls[k], expected, information(scan.walls[k], config), config));
  }
  return best;
}

}  // namespace

double wall_log_likelihood(const StoreyIndex& storey, const Pose2& X_IH, const LocalizationScan& scan,
                           const LikelihoodConfig& config) {
  const std::array<double, max_walls> best = best_mismatch(storey, X_IH, scan, config);
  const double outlier = config.plane_outlier / (4.0 * config.azimuth_gate * config.distance_gate_m);
  // One logarithm of a product, taken before it could leave the range of a double.
  double sum = 0.0, product = 1.0;
  for (std::size_t k = 0; k < scan.walls.size(); ++k) {
    const double peak = peak_density(information(scan.walls[k], config), config);
    product *= outlier + (best[k] < 100.0 ? peak * std::exp(-0.5 * best[k]) : 0.0);
    if (product > 1e-200 && product < 1e200) continue;
    sum += std::log(product);
    product = 1.0;
  }
  sum += std::log(product);
  return config.plane_weight * sum;
}

}  // namespace plumbline::slam
