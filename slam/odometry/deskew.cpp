// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include "bim/digest/digest.h"
#include "slam/odometry/motion.h"

namespace plumbline::slam {

namespace {

constexpr std::size_t digest_stride = 8;

/// Time of a column relative to the scan's stamp: that of its first return slot.
Nanoseconds column_offset(const Scan& scan, std::size_t first) { return scan.offset_ns[first]; }

}  // namespace

DeskewedScan deskew(const Scan& scan, const MotionBuffer& motion, const Calibration& calibration) {
  DeskewedScan out;
  out.stamp = scan.stamp;
  out.rings = scan.rings;
  out.columns = scan.columns;
  out.range_m = scan.range_m;
  out.point_R.assign(scan.size(), Eigen::Vector3d::Zero());
  out.X_RL = calibration.X_RL;

  const Pose X_RO = motion.at(scan.stamp).inverse();
  const auto rings = static_cast<std::size_t>(scan.rings);
  for (std::size_t first = 0; first + rings <= scan.size(); first += rings) {
    // X_RC: the robot at the column's time, seen from the robot at the stamp.
    const Pose X_RC = X_RO * motion.at(scan.stamp + column_offset(scan, first));
    const Pose X_RL = X_RC * calibration.X_RL;
    const Eigen::Matrix3d R_RL = X_RL.rotation();
    for (std::size_t i = first; i < first + rings; ++i)
      if (scan.range_m[i] > 0.0) out.point_R[i] = R_RL * scan.point_L[i] + X_RL.t;
  }
  return out;
}

std::uint64_t digest(const DeskewedScan& scan) {
  Digest sum;
  sum.add(scan.stamp);
  const auto rings = static_cast<std::size_t>(scan.rings);
  for (std::size_t first = 0; first + rings <= scan.point_R.size(); first += digest_stride * rings)
    for (std::size_t i = first; i < first + rings; ++i) sum.add(scan.point_R[i]);
  return sum.value();
}

}  // namespace plumbline::slam
