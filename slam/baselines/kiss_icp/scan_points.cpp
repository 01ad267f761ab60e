// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/kiss_icp/scan_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "slam/scan/voxel.h"

namespace plumbline::slam::kiss {

namespace {

std::size_t slots_of(const Scan& scan) { return std::min(scan.range_m.size(), scan.point_L.size()); }

}  // namespace

ConstantTwist::ConstantTwist(const Pose& motion, Nanoseconds period) : per_ns_(1.0 / static_cast<double>(period)) {
  const Vector6d xi = log_se3(motion);
  rho_ = xi.head<3>();
  angle_rad_ = xi.tail<3>().norm();
  if (angle_rad_ < 1e-9) return;  // a nanometre at 1 m
  axis_ = xi.tail<3>() / angle_rad_;
  across_ = axis_.cross(rho_) / angle_rad_;
  across2_ = axis_.cross(across_);
}

Eigen::Vector3d ConstantTwist::to_stamp(const Eigen::Vector3d& p_L, Nanoseconds offset) const {
  const double s = per_ns_ * static_cast<double>(offset);
  const double angle = s * angle_rad_;
  const double sine_half = std::sin(0.5 * angle), sine = 2.0 * sine_half * std::cos(0.5 * angle);
  const double versine = 2.0 * sine_half * sine_half;  // 1 - cos
  const Eigen::Vector3d turned = axis_.cross(p_L);
  return p_L + sine * turned + versine * axis_.cross(turned) + s * rho_ + versine * across_ + (angle - sine) * across2_;
}

Nanoseconds sweep_duration(const Scan& scan) {
  if (scan.offset_ns.size() != scan.range_m.size()) return 0;
  Nanoseconds first = std::numeric_limits<std::int32_t>::max(), last = std::numeric_limits<std::int32_t>::min();
  for (std::size_t i = 0; i < scan.range_m.size(); ++i) {
    if (!(scan.range_m[i] > 0.0)) continue;
    first = std::min<Nanoseconds>(first, scan.offset_ns[i]);
    last = std::max<Nanoseconds>(last, scan.offset_ns[i]);
  }
  return std::max<Nanoseconds>(0, last - first);
}

ScanPoints deskewed_points(const Scan& scan, const ConstantTwist& twist, double min_range_m, double max_range_m) {
  const double min2 = min_range_m * min_range_m, max2 = max_range_m * max_range_m;
  const bool timed = scan.offset_ns.size() == scan.range_m.size();
  ScanPoints points;
  points.slots.reserve(slots_of(scan));
  points.points_L.reserve(slots_of(scan));
  for (std::size_t i = 0; i < slots_of(scan); ++i) {
    if (!(scan.range_m[i] > 0.0)) continue;
    const Eigen::Vector3d p_L = twist.to_stamp(scan.point_L[i], timed ? scan.offset_ns[i] : 0);
    const double range2 = p_L.squaredNorm();
    if (!(range2 > min2 && range2 < max2)) continue;  // not-a-number compares false
    points.slots.push_back(i);
    points.points_L.push_back(p_L);
  }
  return points;
}

std::vector<Eigen::Vector3d> first_of_voxels(std::span<const Eigen::Vector3d> points_L, double voxel_m) {
  VoxelIndex index;
  std::vector<Eigen::Vector3d> first;
  for (const Eigen::Vector3d& p_L : points_L)
    if (static_cast<std::size_t>(index.insert(VoxelKey::of(p_L, voxel_m))) == first.size()) first.push_back(p_L);
  return first;
}

}  // namespace plumbline::slam::kiss
