// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/wall_variance.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "slam/localization/tracker.h"
#include "slam/localization/tracker_factors.h"

namespace plumbline::slam {

std::vector<SeenWall> seen_walls(const std::deque<TrackedPose>& window, const StoreyIndex& storey, double bias,
                                 const TrackerConfig& config) {
  std::map<int, SeenWall> walls;
  std::map<int, double> turn_weights;  // the longer a patch, the better its direction is known
  const TrackedPose& newest = window.back();
  for (auto it = window.rbegin(); it != window.rend(); ++it) {
    const double waited_s = it == window.rbegin() ? 0.0 : newest.waited_s;
    const double drift =
        config.drift_per_m * (newest.X_OR.t - it->X_OR.t).norm() + config.odometry_standing_m_per_s * waited_s;
    for (const WallLink& link : it->walls) {
      const Eigen::Vector2d& n = storey.lines[static_cast<std::size_t>(link.line)].n;
      const Eigen::Vector2d arm = (it->X_IR * link.observed.centroid_R - newest.X_IR.t).head<2>();
      const Eigen::Vector4d J{n.x(), n.y(), n.y() * arm.x() - n.x() * arm.y(), bias_share(link.observed)};
      SeenWall& wall = walls.try_emplace(link.line, SeenWall{J, 0.0, 0.0, 0.0, 0.0, 0.0}).first->second;
      const double information = link.weight / (link.observed.covariance(2, 2) + drift * drift);
      const double most = config.wall_residual_max_m;
      wall.residual_m += information * std::clamp(wall_residual(*it, link, storey, bias).e[2], -most, most);
      wall.information += information;
      const double length = (link.observed.p1_R - link.observed.p0_R).norm();
      const Eigen::Vector2d seen = (it->X_IR.rotation() * link.observed.plane_R.n).head<2>();
      wall.turn_rad += link.weight * length * length * std::atan2(n.x() * seen.y() - n.y() * seen.x(), n.dot(seen));
      turn_weights[link.line] += link.weight * length * length;
      wall.length = std::max(wall.length, length);
      wall.weight = std::max(wall.weight, link.weight);
    }
  }
  std::vector<SeenWall> seen;
  for (auto& [line, wall] : walls) {
    if (wall.information <= 0.0) continue;
    wall.residual_m /= wall.information;
    if (const double weight = turn_weights.at(line); weight > 0.0) wall.turn_rad /= weight;
    seen.push_back(wall);
  }
  return seen;
}

namespace {

/// Of a wall's mean residual as expected before walls were seen.
double expected_variance(const SeenWall& wall, const TrackerConfig& config) {
  return config.wall_tolerance_m * config.wall_tolerance_m + 1.0 / wall.information;
}

/// Of its direction: that of a line through points whose offsets have the tolerance.
double expected_direction_variance(const SeenWall& wall, const TrackerConfig& config) {
  const double sigma = config.wall_tolerance_m / wall.length;
  return 12.0 * sigma * sigma;
}

}  // namespace

Eigen::Matrix4d wall_information(const std::vector<SeenWall>& walls, const WallVariances& variances,
                                 const TrackerConfig& config) {
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  for (const SeenWall& wall : walls) {
    information += wall.J * wall.J.transpose() * (wall.weight / (variances.offset * expected_variance(wall, config)));
    if (wall.length <= 0.0) continue;
    const double variance = variances.direction * expected_direction_variance(wall, config);
    information(2, 2) += wall.weight / (variance + config.wall_angle_min * config.wall_angle_min);
  }
  return information;
}

void WallVarianceFactor::Sum::add(const Sum& window, const TrackerConfig& config) {
  // Windows overlap: what one adds is a part of it.
  const double part = 1.0 / config.window;
  freedom += part * (window.freedom - config.wall_forgetting * freedom);
  squares += part * (window.squares - config.wall_forgetting * squares);
}

double WallVarianceFactor::Sum::mean(const TrackerConfig& config) const {
  return (config.wall_tolerance_weight + squares) / (config.wall_tolerance_weight + freedom);
}

void WallVarianceFactor::add(const std::vector<SeenWall>& walls, const BiasPrior& bias, const TrackerConfig& config) {
  Eigen::Matrix4d information = wall_information(walls, {}, config);
  // What walls leave open must not count as known.
  constexpr double open_m = 1.0, open_rad = 1.0;  // far above any tracking error
  information.topLeftCorner<2, 2>() += Eigen::Matrix2d::Identity() / (open_m * open_m);
  information(2, 2) += 1.0 / (open_rad * open_rad);
  information(3, 3) += 1.0 / bias.variance;
  const auto direction_variance = [&](const SeenWall& wall) {
    return expected_direction_variance(wall, config) + config.wall_angle_min * config.wall_angle_min;
  };
  Eigen::Vector4d pull{0.0, 0.0, 0.0, (bias.used_m - bias.mean_m) / bias.variance};
  for (const SeenWall& wall : walls) {
    pull += wall.J * (wall.weight * wall.residual_m / expected_variance(wall, config));
    if (wall.length > 0.0) pull[2] += wall.weight * wall.turn_rad / direction_variance(wall);
  }
  const Eigen::Matrix4d P = information.inverse();
  const Eigen::Vector4d fitted = P * pull;
  Sum offsets, directions;
  for (const SeenWall& wall : walls) {
    const double variance = expected_variance(wall, config);
    const double residual = wall.residual_m - wall.J.dot(fitted);
    offsets.squares += wall.weight * residual * residual / variance;
    offsets.freedom += wall.weight * std::max(0.0, 1.0 - wall.weight * wall.J.dot(P * wall.J) / variance);
    if (wall.length <= 0.0) continue;
    const double of_direction = direction_variance(wall), turn = wall.turn_rad - fitted[2];
    directions.squares += wall.weight * turn * turn / of_direction;
    directions.freedom += wall.weight * std::max(0.0, 1.0 - wall.weight * P(2, 2) / of_direction);
  }
  offsets_.add(offsets, config);
  directions_.add(directions, config);
  const double least = config.wall_tolerance_min_m / config.wall_tolerance_m;
  value_ = {std::max(offsets_.mean(config), least * least), directions_.mean(config)};
}

}  // namespace plumbline::slam
