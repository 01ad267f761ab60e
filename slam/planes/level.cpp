// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/level.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bim/geometry/best_rotation.h"
#include "bim/geometry/symmetric.h"

namespace plumbline::slam {

namespace {

/// The direction that the walls' normals are across: least squares, each normal by the variance of its fit.
std::optional<Eigen::Vector3d> up_by_walls(std::span<const PlaneObservation> seen) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (const PlaneObservation& plane : seen) {
    const double variance = plane.covariance(1, 1);
    if (plane.vertical && variance > 0.0) information += plane.plane_R.n * plane.plane_R.n.transpose() / variance;
  }
  const auto [values, vectors] = symmetric_eigen(information);
  // A quarter of the tilt at which a floor is none, FloorLayerConfig::level_rad. The middle value is the information on
  // the tilt that is known less well: of walls of one direction there is none.
  constexpr double most_sigma = 0.02;
  if (values(1) < 1.0 / (most_sigma * most_sigma)) return std::nullopt;
  const Eigen::Vector3d up = vectors.col(0);
  return up.z() < 0.0 ? Eigen::Vector3d(-up) : up;
}

/// The directions in which some of these returns lie.
template <class Counts>
SeenDirections directions_of(const DeskewedScan& scan, const Counts& counts) {
  constexpr int enough = 2;  // returns in a direction; one may be of an edge
  constexpr std::size_t directions = SeenDirections().size();
  std::array<int, directions> returns{};
  for (std::size_t i = 0; i < scan.range_m.size(); ++i) {
    const Eigen::Vector3d& p_R = scan.point_R[i];
    if (scan.range_m[i] <= 0.0 || !counts(p_R)) continue;
    const Eigen::Vector3d ray_R = p_R - scan.X_RL.t;
    const double turn = 0.5 + 0.5 * std::atan2(ray_R.y(), ray_R.x()) / std::numbers::pi;
    ++returns[std::min(static_cast<std::size_t>(turn * directions), directions - 1)];
  }
  SeenDirections seen;
  for (std::size_t k = 0; k < directions; ++k) seen[k] = returns[k] >= enough;
  return seen;
}

}  // namespace

bool is_floor(const PlaneObservation& seen) { return !seen.vertical && seen.plane_R.n.z() > 0.0; }

std::optional<Eigen::Vector3d> up_by_planes(std::span<const PlaneObservation> seen) {
  const PlaneObservation* widest = nullptr;
  for (const PlaneObservation& plane : seen)
    if (!plane.vertical && (widest == nullptr || plane.points > widest->points)) widest = &plane;
  if (widest == nullptr) return up_by_walls(seen);
  return is_floor(*widest) ? widest->plane_R.n : Eigen::Vector3d(-widest->plane_R.n);
}

bool stands_on_lower(const DeskewedScan& scan, const Plane& lower_R, const Plane& upper_R) {
  const SeenDirections lower = directions_of(scan, lower_R), upper = directions_of(scan, upper_R);
  return 2 * (lower & ~upper).count() > lower.count();
}

SeenDirections directions_of(const DeskewedScan& scan, const Plane& plane_R) {
  constexpr double near_m = 0.05;  // of a plane: noise, and the sway that a scan is bent by
  return directions_of(scan, [&](const Eigen::Vector3d& p_R) { return std::abs(plane_R.distance(p_R)) < near_m; });
}

double share_of_directions(const DeskewedScan& scan, const Plane& plane_R) {
  const std::size_t all = directions_of(scan, [](const Eigen::Vector3d&) { return true; }).count();
  return all == 0 ? 0.0 : static_cast<double>(directions_of(scan, plane_R).count()) / static_cast<double>(all);
}

Eigen::Quaterniond level_by_planes(std::span<const PlaneObservation> seen) {
  const std::optional<Eigen::Vector3d> up_R = up_by_planes(seen);
  return up_R ? rotation_between(*up_R, Eigen::Vector3d::UnitZ()) : Eigen::Quaterniond::Identity();
}

}  // namespace plumbline::slam
