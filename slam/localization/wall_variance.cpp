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
  const TrackedPose& newest = window.back();
  for (auto it = window.rbegin(); it != window.rend(); ++it) {
    const double waited_s = it == window.rbegin() ? 0.0 : newest.waited_s;
    const double drift =
        config.drift_per_m * (newest.X_OR.t - it->X_OR.t).norm() + config.odometry_standing_m_per_s * waited_s;
    for (const WallLink& link : it->walls) {
      const Eigen::Vector2d& n = storey.lines[static_cast<std::size_t>(link.line)].n;
      const Eigen::Vector2d arm = (it->X_IR * link.observed.centroid_R - newest.X_IR.t).head<2>();
      const Eigen::Vector4d J{n.x(), n.y(), n.y() * arm.x() - n.x() * arm.y(), bias_share(link.observed)};
      SeenWall& wall = walls.try_emplace(link.line, SeenWall{J, 0.0, 0.0, 0.0, 0.0}).first->second;
      const double information = link.weight / (link.observed.covariance(2, 2) + drift * drift);
      const double most = config.wall_residual_max_m;
      wall.residual_m += information * std::clamp(wall_residual(*it, link, storey, bias).e[2], -most, most);
      wall.information += information;
      wall.length = std::max(wall.length, (link.observed.p1_R - link.observed.p0_R).norm());
      wall.weight = std::max(wall.weight, link.weight);
    }
  }
  std::vector<SeenWall> seen;
  for (auto& [line, wall] : walls) {
    if (wall.information <= 0.0) continue;
    wall.residual_m /= wall.information;
    seen.push_back(wall);
  }
  return seen;
}

namespace {

/// Of a wall's mean residual as expected before walls were seen.
double expected_variance(const SeenWall& wall, const TrackerConfig& config) {
  return config.wall_tolerance_m * config.wall_tolerance_m + 1.0 / wall.information;
}

}  // namespace

Eigen::Matrix4d wall_information(const std::vector<SeenWall>& walls, double factor, const TrackerConfig& config) {
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  for (const SeenWall& wall : walls) {
    information += wall.J * wall.J.transpose() * (wall.weight / (factor * expected_variance(wall, config)));
    if (wall.length <= 0.0) continue;
    const double sigma = std::sqrt(12.0 * factor) * config.wall_tolerance_m / wall.length + config.wall_angle_min;
    information(2, 2) += wall.weight / (sigma * sigma);
  }
  return information;
}

void WallVarianceFactor::add(const std::vector<SeenWall>& walls, const BiasPrior& bias, const TrackerConfig& config) {
  Eigen::Matrix4d information = wall_information(walls, 1.0, config);
  // What walls leave open must not count as known.
  constexpr double open_m = 1.0, open_rad = 1.0;  // far above any tracking error
  information.topLeftCorner<2, 2>() += Eigen::Matrix2d::Identity() / (open_m * open_m);
  information(2, 2) += 1.0 / (open_rad * open_rad);
  information(3, 3) += 1.0 / bias.variance;
  Eigen::Vector4d pull{0.0, 0.0, 0.0, (bias.used_m - bias.mean_m) / bias.variance};
  for (const SeenWall& wall : walls) pull += wall.J * (wall.weight * wall.residual_m / expected_variance(wall, config));
  const Eigen::Matrix4d P = information.inverse();
  const Eigen::Vector4d fitted = P * pull;
  double squares = 0.0, freedom = 0.0;
  for (const SeenWall& wall : walls) {
    const double variance = expected_variance(wall, config);
    const double residual = wall.residual_m - wall.J.dot(fitted);
    squares += wall.weight * residual * residual / variance;
    freedom += wall.weight * std::max(0.0, 1.0 - wall.weight * wall.J.dot(P * wall.J) / variance);
  }
  // Windows overlap: what one adds is a part of it.
  const double part = 1.0 / config.window;
  freedom_ += part * (freedom - config.wall_forgetting * freedom_);
  squares_ += part * (squares - config.wall_forgetting * squares_);
  const double least = config.wall_tolerance_min_m / config.wall_tolerance_m;
  value_ =
      std::max((config.wall_tolerance_weight + squares_) / (config.wall_tolerance_weight + freedom_), least * least);
}

}  // namespace plumbline::slam
