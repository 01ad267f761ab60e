// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/horizontal.h"

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
constexpr int robust_steps = 6;          // ... halved every second step towards the noise

/// Plane by reweighted least squares (Cauchy) from a level plane at the median height.
Plane robust_plane(const DeskewedScan& scan, const std::vector<std::uint32_t>& points) {
  std::vector<Eigen::Vector3d> points_R;  // side by side
  std::vector<double> heights;
  points_R.reserve(points.size());
  heights.reserve(points.size());
  for (const std::uint32_t i : points) {
    points_R.push_back(scan.point_R[i]);
    heights.push_back(scan.point_R[i].z());
  }
  Plane plane{Eigen::Vector3d::UnitZ(), -upper_median(std::move(heights))};
  for (int step = 0; step < robust_steps; ++step) {
    const double scale = kernel_start_m / (1 << (step / 2));
    MomentSums sums;
    for (const Eigen::Vector3d& p : points_R) {
      const double r = plane.distance(p) / scale;
      sums.add(p, 1.0 / (1.0 + r * r));
    }
    plane = refine_plane(sums.moments(), plane, 0.0);
  }
  return plane;
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
    const std::optional<PlaneObservation> patch = fit_patch(scan, points, robust_plane(scan, points), config);
    if (patch && extent_area(scan, points, *patch, config.max_distance_m) >= config.floor_area_m2)
      planes.push_back(*patch);
  }
  return planes;
}

}  // namespace plumbline::slam
