// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/segmented_scan.h"

#include <cmath>

namespace plumbline::slam {

namespace {

constexpr int column_step = 16;
constexpr double within_m = 0.05, beyond_end_m = 0.1;

bool holds(const PlaneObservation& plane, const Eigen::Vector3d& p_R) {
  const Eigen::Vector3d along = plane.p1_R - plane.p0_R;
  const double length = along.head<2>().norm();
  if (length > 0.0) {
    const double s = (p_R - plane.p0_R).head<2>().dot(along.head<2>()) / length;
    if (s < -beyond_end_m || s > length + beyond_end_m) return false;
  }
  return p_R.z() >= plane.z0 - beyond_end_m && p_R.z() <= plane.z1 + beyond_end_m;
}

int plane_of(std::span<const PlaneObservation> seen, const Eigen::Vector3d& p_R) {
  int best = -1;
  double best_m = within_m;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    const double off_m = std::abs(seen[k].plane_R.distance(p_R));
    if (off_m >= best_m || !holds(seen[k], p_R)) continue;
    best = static_cast<int>(k);
    best_m = off_m;
  }
  return best;
}

}  // namespace

SegmentedScan segmented_scan(const DeskewedScan& scan, std::span<const PlaneObservation> seen) {
  SegmentedScan result{scan.stamp, scan.X_RL.t, {}, {}};
  const auto rings = static_cast<std::size_t>(scan.rings);
  for (std::size_t i = 0; i < scan.range_m.size(); ++i) {
    // Clouds without rings are one ring: every 16th of their returns.
    if ((rings > 1 ? i / rings : i) % column_step != 0 || !(scan.range_m[i] > 0.0)) continue;
    const Eigen::Vector3d mm = 1e3 * scan.point_R[i];
    if (!(mm.lpNorm<Eigen::Infinity>() < 1e6)) continue;
    result.point_mm.push_back(mm.array().round().matrix().cast<int>());
    result.plane.push_back(plane_of(seen, scan.point_R[i]));
  }
  return result;
}

}  // namespace plumbline::slam
