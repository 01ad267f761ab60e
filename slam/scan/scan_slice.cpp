// SPDX-License-Identifier: Apache-2.0
#include "slam/scan/scan_slice.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumbline::slam {

ScanSlice cut_scan(const DeskewedScan& scan, const Eigen::Quaterniond& q_HR, double sensor_height,
                   const ScanSliceConfig& config) {
  constexpr double pi = std::numbers::pi;
  const Eigen::Matrix3d R_HR = q_HR.toRotationMatrix();
  const Eigen::Vector3d sensor_H = R_HR * scan.X_RL.t;
  const auto bins = static_cast<std::size_t>(std::lround(360.0 / config.bin_deg));
  std::vector<double> range(bins, 0.0);  // 0: empty
  std::vector<Eigen::Vector2d> end_H(bins);
  for (std::size_t i = 0; i < scan.range_m.size(); ++i) {
    if (scan.range_m[i] <= 0.0) continue;
    const Eigen::Vector3d ray_H = R_HR * scan.point_R[i] - sensor_H;
    const double height = sensor_height + ray_H.z();
    if (height < config.min_height_m || height > config.max_height_m) continue;
    const double r = ray_H.head<2>().norm();
    if (r < config.min_range_m || r > config.max_range_m) continue;
    const double turn = (std::atan2(ray_H.y(), ray_H.x()) + pi) / (2.0 * pi);
    const std::size_t bin = std::min(static_cast<std::size_t>(turn * static_cast<double>(bins)), bins - 1);
    const bool first = range[bin] == 0.0;
    if (!first && (config.pick == SlicePick::minimum ? r >= range[bin] : r <= range[bin])) continue;
    range[bin] = r;
    end_H[bin] = (ray_H + sensor_H).head<2>();
  }
  ScanSlice slice;
  slice.sensor_H = sensor_H.head<2>();
  for (std::size_t bin = 0; bin < bins; ++bin)
    if (range[bin] > 0.0) slice.ends_H.push_back(end_H[bin]);
  return slice;
}

}  // namespace plumbline::slam
