// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/wall_tolerance.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
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

/// Of a wall's mean residual.
double offset_variance(const SeenWall& wall, const WallTolerance& tolerance) {
  return tolerance.offset_m * tolerance.offset_m + tolerance.noise / wall.information;
}

/// Of its direction as expected: that of a line through points whose offsets have the tolerance.
double expected_direction_variance(const SeenWall& wall, const TrackerConfig& config) {
  const double sigma = config.wall_tolerance_m / wall.length;
  return 12.0 * sigma * sigma;
}

double direction_variance(const SeenWall& wall, double share, const TrackerConfig& config) {
  return share * expected_direction_variance(wall, config) + config.wall_angle_min * config.wall_angle_min;
}

/// Pose and range bias that fit a window's walls best, from those at hand.
struct WindowFit {
  Eigen::Matrix4d information, covariance;
  Eigen::Vector4d pull, fitted;
};

WindowFit fit_window(const std::vector<SeenWall>& walls, const BiasPrior& bias, const WallTolerance& tolerance,
                     const TrackerConfig& config) {
  WindowFit fit;
  fit.information = wall_information(walls, tolerance, config);
  // What walls leave open must not count as known.
  constexpr double open_m = 1.0, open_rad = 1.0;  // far above any tracking error
  fit.information.topLeftCorner<2, 2>() += Eigen::Matrix2d::Identity() / (open_m * open_m);
  fit.information(2, 2) += 1.0 / (open_rad * open_rad);
  fit.information(3, 3) += 1.0 / bias.variance;
  fit.pull = {0.0, 0.0, 0.0, (bias.used_m - bias.mean_m) / bias.variance};
  for (const SeenWall& wall : walls) {
    fit.pull += wall.J * (wall.weight * wall.residual_m / offset_variance(wall, tolerance));
    if (wall.length > 0.0)
      fit.pull[2] += wall.weight * wall.turn_rad / direction_variance(wall, tolerance.direction, config);
  }
  fit.covariance = fit.information.inverse();
  fit.fitted = fit.covariance * fit.pull;
  return fit;
}

/// Logarithm of the restricted likelihood of what the walls' offsets leave, but for what no tolerance changes.
double log_restricted_likelihood(const std::vector<SeenWall>& walls, const WindowFit& fit,
                                 const WallTolerance& tolerance) {
  double twice = std::log(fit.information.determinant()) - fit.pull.dot(fit.fitted);
  for (const SeenWall& wall : walls) {
    const double variance = offset_variance(wall, tolerance);
    twice += wall.weight * (std::log(variance) + wall.residual_m * wall.residual_m / variance);
  }
  return -0.5 * twice;
}

}  // namespace

Eigen::Matrix4d wall_information(const std::vector<SeenWall>& walls, const WallTolerance& tolerance,
                                 const TrackerConfig& config) {
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  for (const SeenWall& wall : walls) {
    information += wall.J * wall.J.transpose() * (wall.weight / offset_variance(wall, tolerance));
    if (wall.length > 0.0) information(2, 2) += wall.weight / direction_variance(wall, tolerance.direction, config);
  }
  return information;
}

WallTolerances::WallTolerances(const TrackerConfig& config) : least_m_(config.wall_tolerance_min_m) {
  // As if so many walls had stood off by the tolerance expected.
  for (int i = 0; i < count; ++i) {
    const double ratio = config.wall_tolerance_m / tolerance(i).offset_m;
    log_prior_[static_cast<std::size_t>(i)] =
        0.5 * config.wall_tolerance_weight * (2.0 * std::log(ratio) - ratio * ratio);
  }
}

WallTolerance WallTolerances::tolerance(int i) const {
  return {least_m_ * std::pow(largest_m / least_m_, static_cast<double>(i % offsets) / (offsets - 1)),
          std::pow(0.25, i / offsets), direction_};
}

std::array<double, WallTolerances::count> WallTolerances::probabilities() const {
  std::array<double, count> p{};
  double largest = -std::numeric_limits<double>::infinity(), sum = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) largest = std::max(largest, p[i] = log_prior_[i] + log_likelihood_[i]);
  for (double& value : p) sum += value = std::exp(value - largest);
  for (double& value : p) value /= sum;
  return p;
}

WallTolerance WallTolerances::mean() const {
  const std::array<double, count> p = probabilities();
  double square = 0.0;
  for (int i = 0; i < count; ++i) square += p[static_cast<std::size_t>(i)] * std::pow(tolerance(i).offset_m, 2);
  return {std::sqrt(square), 1.0, direction_};
}

void WallTolerances::add(const std::vector<SeenWall>& walls, const BiasPrior& bias, const TrackerConfig& config) {
  // Windows overlap: what one adds is a part of it.
  const double part = 1.0 / config.window;
  for (int i = 0; i < count; ++i) {
    double& sum = log_likelihood_[static_cast<std::size_t>(i)];
    const WindowFit fit = fit_window(walls, bias, tolerance(i), config);
    const double window = log_restricted_likelihood(walls, fit, tolerance(i));
    sum += part * (window - config.wall_forgetting * sum);
  }
  const WindowFit fit = fit_window(walls, bias, {mean().offset_m, 1.0, 1.0}, config);
  double squares = 0.0, freedom = 0.0;
  for (const SeenWall& wall : walls) {
    if (wall.length <= 0.0) continue;
    const double variance = direction_variance(wall, 1.0, config), turn = wall.turn_rad - fit.fitted[2];
    squares += wall.weight * turn * turn / variance;
    freedom += wall.weight * std::max(0.0, 1.0 - wall.weight * fit.covariance(2, 2) / variance);
  }
  turn_freedom_ += part * (freedom - config.wall_forgetting * turn_freedom_);
  turn_squares_ += part * (squares - config.wall_forgetting * turn_squares_);
  direction_ = (config.wall_tolerance_weight + turn_squares_) / (config.wall_tolerance_weight + turn_freedom_);
}

}  // namespace plumbline::slam
