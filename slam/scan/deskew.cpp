// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <vector>

#include "bim/digest/digest.h"
#include "bim/median.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

namespace {

constexpr std::size_t digest_stride = 8;
constexpr Nanoseconds one_firing = 100'000;
constexpr double max_range_m = 1e3;  ///< beyond what any of the LiDARs can measure

/// A finite point no farther than its range says; NaN compares false.
bool is_return(const Scan& scan, std::size_t i) {
  const double range = scan.range_m[i];
  const double farthest = 1.01 * range + 1.0;
  return range > 0.0 && range < max_range_m && scan.point_L[i].squaredNorm() < farthest * farthest;
}

/// By how many columns each ring stands behind the lowest at the same azimuth. Rings of one firing less than two
/// columns apart, as those of a VLP-16, count as in line.
std::vector<int> column_shifts(const Scan& scan) {
  constexpr int every = 16;  // columns: enough for a median
  std::vector<int> shifts(static_cast<std::size_t>(scan.rings), 0);
  std::vector<double> apart;
  for (int ring = 1; ring < scan.rings; ++ring) {
    apart.clear();
    for (int column = 0; column < scan.columns; column += every) {
      const auto i = static_cast<std::size_t>(column * scan.rings + ring);
      if (!is_return(scan, i) || !is_return(scan, i - 1)) continue;
      const Eigen::Vector3d &p = scan.point_L[i], &below = scan.point_L[i - 1];
      apart.push_back(std::atan2(below.x() * p.y() - below.y() * p.x(), below.x() * p.x() + below.y() * p.y()));
    }
    int shift = 0;
    if (!apart.empty())  // turns clockwise
      shift = static_cast<int>(std::lround(upper_median(apart) * scan.columns / (2.0 * std::numbers::pi)));
    const auto r = static_cast<std::size_t>(ring);
    shifts[r] = shifts[r - 1] + (std::abs(shift) < 2 ? 0 : shift);
  }
  return shifts;
}

}  // namespace

DeskewedScan deskew(const Scan& scan, const MotionBuffer& motion, const Calibration& calibration) {
  DeskewedScan out;
  out.stamp = scan.stamp;
  out.rings = scan.rings;
  out.columns = scan.columns;
  out.range_m.assign(scan.size(), 0.0);
  out.point_R.assign(scan.size(), Eigen::Vector3d::Zero());
  out.X_RL = calibration.X_RL;
  const bool timed = std::any_of(scan.offset_ns.begin(), scan.offset_ns.end(), [](auto offset) { return offset != 0; });
  if (timed) out.time_s.assign(scan.size(), 0.0F);
  if (!has_rings(scan)) out.elevation.assign(scan.size(), 0.0);
  out.odometry_stale = motion.is_stale_at(scan.stamp);
  out.odometry_age = motion.age_at(scan.stamp);

  const Pose X_RO = motion.at(scan.stamp).inverse();
  const auto rings = static_cast<std::size_t>(scan.rings);
  const std::vector<int> shifts = column_shifts(scan);
  for (int column = 0; column < scan.columns; ++column) {
    const auto first = static_cast<std::size_t>(column) * rings;
    std::optional<Nanoseconds> offset;  // that the pose of the LiDAR is of
    Pose X_RL;
    Eigen::Matrix3d R_RL = Eigen::Matrix3d::Identity();
    for (std::size_t ring = 0; ring < rings; ++ring) {
      const int aligned = column - shifts[ring];
      if (!is_return(scan, first + ring) || aligned < 0 || aligned >= scan.columns) continue;
      if (const Nanoseconds own = scan.offset_ns[first + ring]; !offset || std::abs(own - *offset) > one_firing) {
        offset = own;
        // The robot then, seen from the robot at the stamp.
        X_RL = X_RO * motion.at(scan.stamp + own) * calibration.X_RL;
        R_RL = X_RL.rotation();
      }
      const std::size_t i = static_cast<std::size_t>(aligned) * rings + ring;
      out.range_m[i] = scan.range_m[first + ring];
      out.point_R[i] = R_RL * scan.point_L[first + ring] + X_RL.t;
      if (!out.elevation.empty()) out.elevation[i] = elevation(scan.point_L[first + ring]);
      if (timed) out.time_s[i] = static_cast<float>(seconds(scan.offset_ns[first + ring]));
    }
  }
  return out;
}

void correct_motion(DeskewedScan& scan, const Vector6d& twist) {
  constexpr float one_firing_s = 1e-4F;
  std::optional<float> time;  // that the correction is of
  Pose correction;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  for (std::size_t i = 0; i < scan.time_s.size(); ++i) {
    if (scan.range_m[i] <= 0.0) continue;
    if (!time || std::abs(scan.time_s[i] - *time) > one_firing_s) {
      time = scan.time_s[i];
      correction = exp_se3(twist * static_cast<double>(*time));
      R = correction.rotation();
    }
    scan.point_R[i] = R * scan.point_R[i] + correction.t;
  }
}

DeskewedScan as_deskewed(const Scan& scan, const Calibration& calibration) {
  MotionBuffer still;
  still.add({scan.stamp, Pose{}});
  return deskew(scan, still, calibration);
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
