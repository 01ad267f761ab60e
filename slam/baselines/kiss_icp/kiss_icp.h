// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "slam/io/method.h"
#include "slam/scan/map_cloud.h"

namespace plumbline::slam {

struct KissIcpConfig {
  double max_range_m = 100.0;
  double min_range_m = 0.0;
  double voxel_m = 0.0;
  int max_points_per_voxel = 20;
  double initial_threshold_m = 2.0;
  double min_motion_m = 0.1;
  int max_iterations = 100;
  double convergence = 1e-4;
  bool second_thinning = true;
  bool deskew = true;
  bool deskew_by_interval = true;
  MapCloudConfig map;

  /// Voxel size of the local map, m.
  [[nodiscard]] double map_voxel_m() const { return voxel_m > 0.0 ? voxel_m : 0.01 * max_range_m; }

  template <class V>
  void visit(V& v) {
    v("max_range_m", max_range_m,
      Field{.doc = "range from which returns are ignored and the local map ends; turns are weighed by it",
            .min = 1.0,
            .max = 1000.0,
            .basic = true});
    v("min_range_m", min_range_m,
      Field{.doc = "range up to which returns are ignored", .min = 0.0, .max = 1000.0, .basic = true});
    v("voxel_m", voxel_m,
      Field{.doc = "voxel size of the local map; 0: a hundredth of max_range_m",
            .min = 0.0,
            .max = 100.0,
            .basic = true});
    v("max_points_per_voxel", max_points_per_voxel,
      Field{.doc = "points that a voxel of the local map holds, voxel / sqrt(their number) apart",
            .min = 1,
            .max = 1000,
            .basic = true});
    v("initial_threshold_m", initial_threshold_m,
      Field{.doc = "first deviation from the predicted pose; correspondences reach three times their rms",
            .min = 1e-3,
            .max = 100.0,
            .basic = true});
    v("min_motion_m", min_motion_m,
      Field{.doc = "deviation from the predicted pose up to which it does not count", .min = 0.0, .max = 100.0});
    v("max_iterations", max_iterations, Field{.doc = "most iterations of a registration", .min = 1, .max = 10000});
    v("convergence", convergence,
      plain_field("length of a step, in m and rad together, below which the iteration stops",
                  {.min = 0.0, .max = 1.0}));
    v("second_thinning", second_thinning,
      Field{.doc = "register one point a voxel of 1.5 times the map's; else one a voxel of half of it", .basic = true});
    v("deskew", deskew,
      Field{.doc = "undo the motion within a scan, which is taken to continue the last one", .basic = true});
    v("deskew_by_interval", deskew_by_interval,
      Field{.doc = "the last motion took the interval between scans; else, as in the reference, the time of a scan"});
    v("map", map);
  }
};

/// Defaults for rooms and LiDARs of few rings.
struct KissIcpIndoorConfig : KissIcpConfig {
  KissIcpIndoorConfig() {
    max_range_m = 30.0;
    min_range_m = 0.5;
    second_thinning = false;
  }
};

/// KISS-ICP [vizzo2023]: point-to-point ICP of each scan with a local map of points, from where constant velocity
/// leads. It uses returns alone; where they have times, scans are deskewed. LOST where no point has a map point near.
[[nodiscard]] std::unique_ptr<Method> make_kiss_icp(const MethodInput& input, const KissIcpConfig& config);

}  // namespace plumbline::slam
