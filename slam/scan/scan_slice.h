// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "bim/config/visit.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

/// Which return of a bin stands for it. The smallest range is what a planar scanner's driver gives and meets furniture
/// first; the largest looks past it, and through openings.
enum class SlicePick { minimum, maximum };
[[nodiscard]] constexpr std::array<std::string_view, 2> names_of(SlicePick) { return {"minimum", "maximum"}; }

struct ScanSliceConfig {
  SlicePick pick = SlicePick::minimum;
  double min_height_m = 0.4;
  double max_height_m = 1.8;
  double bin_deg = 1.0;
  double min_range_m = 0.5;
  double max_range_m = 100.0;

  template <class V>
  void visit(V& v) {
    v("pick", pick, Field{.doc = "return that stands for a bin: minimum or maximum range"});
    // A trotting body makes the floor appear below.
    v("min_height_m", min_height_m, Field{.doc = "least height of a return above the floor", .min = -10, .max = 100});
    // Below the heads of doors.
    v("max_height_m", max_height_m, Field{.doc = "largest height of a return above the floor", .min = -10, .max = 100});
    v("bin_deg", bin_deg, Field{.doc = "bin width in azimuth", .min = 0.05, .max = 30});
    v("min_range_m", min_range_m,
      Field{.doc = "least range of a return that is used; nearer is the robot's own body", .min = 0});
    v("max_range_m", max_range_m, Field{.doc = "largest range of a return that is used", .min = 0});
  }
};

/// A planar scan as a planar scanner would give it, level with the floor.
struct ScanSlice {
  Eigen::Vector2d sensor_H = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector2d> ends_H;  ///< by azimuth; bins without a return are left out
};

/// Cuts the scan between two heights in a frame that gravity holds level. sensor_height: of L above the floor, m.
[[nodiscard]] ScanSlice cut_scan(const DeskewedScan& scan, const Eigen::Quaterniond& q_HR, double sensor_height,
                                 const ScanSliceConfig& config);

}  // namespace plumbline::slam
