// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/associate.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "slam/graph/factors.h"

namespace plumbline::slam {

namespace {

/// Length of a patch from s0 to s1 along a line that lies on its faces and not in their openings, m.
double length_on_faces(const WallLine& line, double s0, double s1, double margin) {
  double length = std::min(s1, line.length + margin) - std::max(s0, -margin);
  for (const Eigen::Vector2d& opening : line.openings)
    length -= std::max(0.0, std::min(s1, opening.y()) - std::max(s0, opening.x()));
  return length;
}

/// Squared Mahalanobis distance of (yaw of the normal, offset), or infinity where the patch is not on the line.
double squared_distance(const WallLine& line, const WallObservation& wall, const PlaneObservation& observed,
                        const LocalizationScan& scan, const Pose& X_IR, const Eigen::Matrix2d& covariance,
                        const TrackerConfig& config) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Pose2 X_IH = heading(X_IR);
  const Eigen::Vector2d sensor_I = X_IH * scan.sensor_H;
  const double foot = line.e.dot(sensor_I - line.a);
  const double overlap = length_on_faces(line, foot + wall.s0, foot + wall.s1, config.overlap_margin_m);
  const double distance = line.n.dot(sensor_I) + line.d;
  if (distance <= 0.0 || overlap < config.overlap_min * (wall.s1 - wall.s0)) return infinity;
  const double e_angle = wrap_angle(wall.azimuth + X_IH.yaw - line.azimuth);
  const double e_offset = wall.distance - distance;
  // The prediction may be off by what the odometry or the convergence left.
  const double var_angle = observed.covariance(0, 0) + config.plane_angle_sigma * config.plane_angle_sigma +
                           config.anchor_sigma_rad * config.anchor_sigma_rad;
  const double var_offset = observed.covariance(2, 2) + config.plane_offset_sigma_m * config.plane_offset_sigma_m +
                            std::max(config.anchor_sigma_m * config.anchor_sigma_m, line.n.dot(covariance * line.n));
  return e_angle * e_angle / var_angle + e_offset * e_offset / var_offset;
}

bool bounds_room(const StoreyIndex& storey, int room, const WallLine& line) {
  const Polygon2& polygon = storey.rooms[static_cast<std::size_t>(room)].polygon;
  // Room outlines may run along the walls' reference lines, half a thickness behind the face.
  constexpr double wall_half_m = 0.3;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    if (std::abs((b - a).normalized().dot(line.n)) > 0.05) continue;
    const double offset = -(line.n.dot(a) + line.d);
    const double s_a = line.e.dot(a - line.a), s_b = line.e.dot(b - line.a);
    const bool overlaps = std::max(s_a, s_b) > 0.0 && std::min(s_a, s_b) < line.length;
    if (overlaps && offset > -0.05 && offset < wall_half_m) return true;
  }
  return false;
}

}  // namespace

Plane plane_of(const WallLine& line) { return {{line.n.x(), line.n.y(), 0.0}, line.d}; }

std::vector<WallLink> associate_walls(const StoreyIndex& storey, const LocalizationScan& scan,
                                      const std::vector<PlaneObservation>& planes, const Pose& X_IR,
                                      const Eigen::Matrix2d& covariance, const TrackerConfig& config) {
  std::vector<WallLink> links;
  const int cell = storey.grid.cell_at(heading(X_IR) * scan.sensor_H);
  if (cell < 0) return links;
  for (const WallObservation& wall : scan.walls) {
    const PlaneObservation& observed = planes[static_cast<std::size_t>(wall.observation)];
    int best = -1;
    double best_distance = config.gate * config.gate;
    for (const int i : storey.visible[static_cast<std::size_t>(cell)]) {
      const double d2 =
          squared_distance(storey.lines[static_cast<std::size_t>(i)], wall, observed, scan, X_IR, covariance, config);
      if (d2 >= best_distance) continue;
      best_distance = d2;
      best = i;
    }
    if (best >= 0) links.push_back({best, observed});
  }
  return links;
}

std::vector<PlaneObservation> level_planes_below(const LocalizationScan& scan,
                                                 const std::vector<PlaneObservation>& planes,
                                                 const TrackerConfig& config) {
  std::vector<PlaneObservation> level;
  for (const PlaneObservation& plane : planes)
    if (scan.is_below(plane.plane_R) && (scan.q_HR * plane.plane_R.n).z() > std::cos(config.floor_max_tilt))
      level.push_back(plane);
  return level;
}

Plane nearest_floor(const StoreyIndex& storey, const PlaneObservation& observed, Pose X_IR, double standing_m,
                    const TrackerConfig& config) {
  X_IR.t.z() = storey.floor_at(X_IR.t.head<2>()) + standing_m;
  const Eigen::Vector3d sigmas(config.floor_angle_sigma, config.floor_angle_sigma, config.floor_offset_sigma_m);
  const std::vector<Plane> planes = storey.floor_planes();
  const auto distance = [&](const Plane& plane) {
    return plane_residual(X_IR, plane, observed.plane_R).e.cwiseQuotient(sigmas).squaredNorm();
  };
  return *std::min_element(planes.begin(), planes.end(),
                           [&](const Plane& a, const Plane& b) { return distance(a) < distance(b); });
}

std::vector<WallPair> opposed_pairs(const StoreyIndex& storey, const TrackedPose& pose, const TrackerConfig& config) {
  std::vector<WallPair> pairs;
  if (pose.room < 0) return pairs;
  std::vector<bool> used(pose.walls.size(), false);
  const auto line = [&](std::size_t i) -> const WallLine& {
    return storey.lines[static_cast<std::size_t>(pose.walls[i].line)];
  };
  for (std::size_t a = 0; a < pose.walls.size(); ++a) {
    if (used[a] || !bounds_room(storey, pose.room, line(a))) continue;
    for (std::size_t b = a + 1; b < pose.walls.size(); ++b) {
      if (used[b] || line(a).n.dot(line(b).n) > -config.pair_min_cos || !bounds_room(storey, pose.room, line(b)))
        continue;
      used[a] = used[b] = true;
      pairs.push_back({static_cast<int>(a), static_cast<int>(b)});
      break;
    }
  }
  return pairs;
}

}  // namespace plumbline::slam
