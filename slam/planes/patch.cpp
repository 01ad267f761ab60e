// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/patch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "slam/scan/moments.h"

namespace plumbline::slam {

namespace {

constexpr int gated_fits = 3;

/// Longer horizontal direction of a patch: along a wall, or the main axis of a floor.
Eigen::Vector3d long_axis(const Plane& plane, const Moments& moments) {
  const Tangents t = plane_tangents(plane.n);
  if (std::abs(plane.n.z()) < 0.5) return t.u;
  const Eigen::Matrix2d s = moments.covariance().topLeftCorner<2, 2>();
  const double angle = 0.5 * std::atan2(2.0 * s(0, 1), s(0, 0) - s(1, 1));
  return {std::cos(angle), std::sin(angle), 0.0};
}

void set_extent(const DeskewedScan& scan, const std::vector<std::uint32_t>& points, double gate,
                const Eigen::Vector3d& axis, PlaneObservation& patch) {
  double s0 = std::numeric_limits<double>::infinity();
  double s1 = -s0;
  patch.z0 = s0;
  patch.z1 = s1;
  for (const std::uint32_t i : points) {
    const Eigen::Vector3d& p = scan.point_R[i];
    if (std::abs(patch.plane_R.distance(p)) > gate) continue;
    const double s = axis.dot(p - patch.centroid_R);
    s0 = std::min(s0, s);
    s1 = std::max(s1, s);
    patch.z0 = std::min(patch.z0, p.z());
    patch.z1 = std::max(patch.z1, p.z());
  }
  patch.p0_R = patch.centroid_R + s0 * axis;
  patch.p1_R = patch.centroid_R + s1 * axis;
}

/// What the lasers' own range offsets do to a wall, which all points of a laser share: standard deviations of its tilt,
/// rad, and of its offset at the centroid, m.
struct LaserBias {
  double tilt_rad = 0.0, offset_m = 0.0;
};

/// Least squares through points whose laser r is off by b_r turn a wall by sum_r b_r n_r h_r / sum_r n_r h_r^2, with
/// n_r points at the mean height h_r above the centroid, and move it by sum_r b_r n_r / n.
LaserBias laser_bias(const DeskewedScan& scan, const std::vector<std::uint32_t>& points, double gate,
                     const PlaneObservation& patch, double laser_sigma_m) {
  const Eigen::Vector3d up = plane_tangents(patch.plane_R.n).v;
  std::vector<double> count(static_cast<std::size_t>(scan.rings), 0.0), height(count);
  double spread = 0.0;
  for (const std::uint32_t i : points) {
    const Eigen::Vector3d& p = scan.point_R[i];
    if (std::abs(patch.plane_R.distance(p)) > gate) continue;
    const double h = up.dot(p - patch.centroid_R);
    const std::size_t ring = i % count.size();
    count[ring] += 1.0;
    height[ring] += h;
    spread += h * h;
  }
  double turn = 0.0, move = 0.0, n = 0.0;
  for (std::size_t r = 0; r < count.size(); ++r) {
    turn += height[r] * height[r];
    move += count[r] * count[r];
    n += count[r];
  }
  if (n == 0.0 || spread == 0.0) return {};
  return {laser_sigma_m * std::sqrt(turn) / spread, laser_sigma_m * std::sqrt(move) / n};
}

}  // namespace

std::optional<PlaneObservation> fit_patch(const DeskewedScan& scan, const std::vector<std::uint32_t>& points,
                                          const Plane& start, const PlaneDetectorConfig& config) {
  PlaneObservation patch;
  patch.plane_R = start;
  Moments moments;
  for (int k = 0; k < gated_fits; ++k) {
    MomentSums sums;
    const Plane plane_R = patch.plane_R;
    for (const std::uint32_t i : points) {
      const Eigen::Vector3d& p = scan.point_R[i];
      if (std::abs(plane_R.distance(p)) <= config.max_distance_m) sums.add(p);
    }
    moments = sums.moments();
    if (moments.n < config.min_points) return std::nullopt;
    patch.plane_R = refine_plane(moments, patch.plane_R, 0.0);
    if (!patch.plane_R.n.allFinite()) return std::nullopt;  // the returns span no plane
  }
  if (patch.plane_R.distance(scan.X_RL.t) < 0.0) patch.plane_R = patch.plane_R.flipped();
  patch.points = static_cast<int>(moments.n);
  patch.rms_m = plane_rms(moments, patch.plane_R);
  patch.centroid_R = moments.mean();
  set_extent(scan, points, config.max_distance_m, long_axis(patch.plane_R, moments), patch);
  const double length = std::max((patch.p1_R - patch.p0_R).norm(), config.min_length_m);
  const double turn = std::hypot(config.bias_floor_rad, config.bias_end_m / length);
  const LaserBias lasers = config.laser_sigma_m > 0.0 && std::abs(patch.plane_R.n.z()) < 0.5
                               ? laser_bias(scan, points, config.max_distance_m, patch, config.laser_sigma_m)
                               : LaserBias{};
  patch.covariance = plane_covariance(moments, patch.plane_R, std::max(patch.rms_m, config.sigma_min_m),
                                      {turn, std::hypot(config.bias_floor_tilt_rad, lasers.tilt_rad),
                                       std::hypot(config.bias_floor_m, lasers.offset_m)});
  return patch;
}

}  // namespace plumbline::slam
