// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/horizontal.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "bim/median.h"
#include "slam/planes/patch.h"
#include "slam/scan/moments.h"

namespace plumbline::slam {

namespace {

constexpr double clearance_m = 0.2;      // returns this near the sensor's own height belong to neither
constexpr double kernel_start_m = 0.15;  // robust scale: a tilt of 2 degrees at 4 m, ...
constexpr double kernel_end_m = 0.0375;  // ... and what noise needs

/// Plane by reweighted least squares (Cauchy), whose scale is halved every second step towards `kernel_end_m`.
Plane robust_plane(const std::vector<Eigen::Vector3d>& points_R, Plane plane, double kernel_m) {
  for (int step = 0; kernel_m >= kernel_end_m; ++step) {
    MomentSums sums;
    for (const Eigen::Vector3d& p : points_R) {
      const double r = plane.distance(p) / kernel_m;
      sums.add(p, 1.0 / (1.0 + r * r));
    }
    plane = refine_plane(sums.moments(), plane, 0.0);
    if (step % 2 == 1) kernel_m *= 0.5;
  }
  return plane;
}

/// From a level plane at the median height: any tilt of the sensor, one surface.
Plane plane_of_one_surface(const std::vector<Eigen::Vector3d>& points_R) {
  std::vector<double> heights;
  heights.reserve(points_R.size());
  for (const Eigen::Vector3d& p : points_R) heights.push_back(p.z());
  return robust_plane(points_R, {Eigen::Vector3d::UnitZ(), -upper_median(std::move(heights))}, kernel_start_m);
}

/// Slopes of height along x and y that level surfaces of whatever height have in common: of the lines from return to
/// return above, robustly (Cauchy).
Eigen::Vector2d common_slope(const DeskewedScan& scan, const std::vector<std::uint32_t>& points,
                             const std::vector<Facing>& facing) {
  constexpr double rise_sigma_m = 0.02,
                   slope_sigma = 0.05;  // of the rise between returns of neighbouring rings; prior of the sensor's tilt
  constexpr int steps = 5;
  const auto rings = static_cast<std::size_t>(scan.rings);
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  for (int step = 0; step < steps; ++step) {
    Eigen::Matrix2d h = Eigen::Matrix2d::Identity() * std::pow(rise_sigma_m / slope_sigma, 2);
    Eigen::Vector2d g = Eigen::Vector2d::Zero();
    for (const std::uint32_t i : points) {
      if (i % rings + 1 == rings || facing[i + 1] != Facing::flat) continue;
      const Eigen::Vector3d line = scan.point_R[i + 1] - scan.point_R[i];
      const Eigen::Vector2d run = line.head<2>();
      const double r = (line.z() - run.dot(slope)) / rise_sigma_m, weight = 1.0 / (1.0 + r * r);
      h += weight * run * run.transpose();
      g += weight * line.z() * run;
    }
    slope = h.ldlt().solve(g);
  }
  return slope;
}

/// From the common slope at the height that most returns have: one of several surfaces, the sensor's tilt known.
Plane plane_of_fullest_height(const std::vector<Eigen::Vector3d>& points_R, const Eigen::Vector2d& slope) {
  constexpr double layer_m = 0.06;
  std::vector<double> heights;
  heights.reserve(points_R.size());
  for (const Eigen::Vector3d& p : points_R) heights.push_back(p.z() - slope.dot(p.head<2>()));
  std::sort(heights.begin(), heights.end());
  std::size_t most = 0, low = 0;
  double height = heights.front();
  for (std::size_t high = 0; high < heights.size(); ++high) {
    while (heights[high] - heights[low] > layer_m) ++low;
    if (high - low < most) continue;
    most = high - low;
    height = heights[(low + high) / 2];
  }
  const double norm = std::sqrt(1.0 + slope.squaredNorm());
  const Eigen::Vector3d n = Eigen::Vector3d(-slope.x(), -slope.y(), 1.0) / norm;
  return robust_plane(points_R, {n, -height / norm}, kernel_end_m);
}

/// How many returns lie on the plane, those off by less than the kernel in part.
double support(const std::vector<Eigen::Vector3d>& points_R, const Plane& plane) {
  double sum = 0.0;
  for (const Eigen::Vector3d& p : points_R) {
    const double r = plane.distance(p) / kernel_end_m;
    sum += std::max(0.0, 1.0 - r * r);
  }
  return sum;
}

/// Beds and tables pull a fit that starts level off the floor, and it ends tilted through both. Where it holds too few
/// returns, a second one starts from the common slope; the better supported is taken.
Plane level_plane(const DeskewedScan& scan, const std::vector<std::uint32_t>& points,
                  const std::vector<Facing>& facing) {
  // Looked at: 40 furnished rooms of the test.
  constexpr double one_surface = 0.7;  // share of the returns on a plane from which on there is no other to look for
  constexpr double clearly = 1.1;      // what two starts of the same fit differ by is noise
  const std::vector<Eigen::Vector3d> points_R = points_of(scan, points);
  const Plane first = plane_of_one_surface(points_R);
  const double supported = support(points_R, first);
  if (supported >= one_surface * static_cast<double>(points.size())) return first;
  const Plane second = plane_of_fullest_height(points_R, common_slope(scan, points, facing));
  return support(points_R, second) > clearly * supported ? second : first;
}

/// Extent across the patch's long axis times that along it.
double extent_area(const DeskewedScan& scan, const std::vector<std::uint32_t>& points, const PlaneObservation& patch,
                   double gate) {
  const Eigen::Vector3d along = (patch.p1_R - patch.p0_R).normalized();
  const Eigen::Vector3d across = patch.plane_R.n.cross(along);
  double low = 0.0;
  double high = 0.0;
  for (const std::uint32_t i : points) {
    if (std::abs(patch.plane_R.distance(scan.point_R[i])) > gate) continue;
    const double s = across.dot(scan.point_R[i] - patch.centroid_R);
    low = std::min(low, s);
    high = std::max(high, s);
  }
  return (high - low) * (patch.p1_R - patch.p0_R).norm();
}

}  // namespace

std::vector<PlaneObservation> horizontal_planes(const DeskewedScan& scan, const std::vector<Facing>& facing,
                                                const PlaneDetectorConfig& config) {
  std::vector<PlaneObservation> planes;
  for (const double side : {-1.0, 1.0}) {
    std::vector<std::uint32_t> points;
    for (std::size_t i = 0; i < facing.size(); ++i)
      if (facing[i] == Facing::flat && side * (scan.point_R[i].z() - scan.X_RL.t.z()) > clearance_m)
        points.push_back(static_cast<std::uint32_t>(i));
    if (points.size() < static_cast<std::size_t>(config.min_points)) continue;
    const std::optional<PlaneObservation> patch = fit_patch(scan, points, level_plane(scan, points, facing), config);
    if (patch && extent_area(scan, points, *patch, config.max_distance_m) >= config.floor_area_m2)
      planes.push_back(*patch);
  }
  return planes;
}

}  // namespace plumbline::slam
