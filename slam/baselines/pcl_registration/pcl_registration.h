// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string_view>

#include "slam/baselines/pcl_registration/pcl_matcher.h"
#include "slam/io/method.h"
#include "slam/scan/map_cloud.h"

namespace plumbline::slam {

/// Where a registration starts.
enum class PclGuess { odometry, constant_velocity };
[[nodiscard]] constexpr std::array<std::string_view, 2> names_of(PclGuess) { return {"odometry", "constant_velocity"}; }

/// Which registrations are believed.
struct PclFitConfig {
  double matched_m = 0.2;
  double min_matched = 0.5;
  double max_correction_m = 2.0;
  double max_correction_rad = 0.6;
  int bad_scans = 3;
  int good_scans = 10;
  int restart_scans = 20;

  template <class V>
  void visit(V& v) {
    v("matched_m", matched_m,
      Field{.doc = "distance from a map point up to which a point counts as matched", .min = 0.01, .max = 10.0});
    v("min_matched", min_matched, share_field("least share of a scan's points that must match"));
    v("max_correction_m", max_correction_m, Field{.doc = "largest distance of the answer from its guess", .min = 0.01});
    v("max_correction_rad", max_correction_rad, Field{.doc = "and largest angle", .min = 0.01, .max = 3.2});
    v("bad_scans", bad_scans, Field{.doc = "bad scans in a row after which the method is lost", .min = 1});
    v("good_scans", good_scans, Field{.doc = "good scans in a row after which it has recovered", .min = 1});
    v("restart_scans", restart_scans, Field{.doc = "bad scans in a row after which a new map starts", .min = 1});
  }
};

/// What is registered with what.
struct PclLocalMapConfig {
  PclGuess guess = PclGuess::odometry;
  double min_range_m = 0.5;
  double max_range_m = 50.0;
  double scan_voxel_m = 0.25;
  double map_voxel_m = 0.2;
  double keyframe_distance_m = 0.5;
  double keyframe_angle_rad = 0.35;
  int keyframes = 10;
  PclFitConfig fit;

  template <class V>
  void visit(V& v) {
    v("guess", guess,
      Field{.doc = "start of a registration: the motion of the robot's odometry, or that of the last two scans",
            .basic = true});
    v("min_range_m", min_range_m, Field{.doc = "least range of a return that is used", .min = 0.0});
    v("max_range_m", max_range_m, Field{.doc = "largest range of a return that is used", .min = 1.0, .max = 1000.0});
    v("scan_voxel_m", scan_voxel_m,
      Field{.doc = "voxel size at which a scan is thinned", .min = 0.02, .max = 10.0, .basic = true});
    v("map_voxel_m", map_voxel_m, Field{.doc = "voxel size of the local map", .min = 0.02, .max = 10.0, .basic = true});
    v("keyframe_distance_m", keyframe_distance_m,
      Field{.doc = "distance walked after which a scan enters the local map", .min = 0.01, .max = 100.0});
    v("keyframe_angle_rad", keyframe_angle_rad,
      Field{.doc = "or angle turned after which it does", .min = 0.01, .max = 3.2});
    v("keyframes", keyframes, Field{.doc = "scans in the local map, the latest", .min = 1, .max = 200, .basic = true});
    v("fit", fit);
  }
};

struct PclGicpMethodConfig {
  PclGicpConfig gicp;
  PclLocalMapConfig local_map;
  MapCloudConfig map;

  template <class V>
  void visit(V& v) {
    v("gicp", gicp);
    v("local_map", local_map);
    v("map", map);
  }
};

struct PclNdtMethodConfig {
  PclNdtConfig ndt;
  PclLocalMapConfig local_map;
  MapCloudConfig map;
  PclNdtMethodConfig() { local_map.map_voxel_m = 0.1; }  // a cell needs six points

  template <class V>
  void visit(V& v) {
    v("ndt", ndt);
    v("local_map", local_map);
    v("map", map);
  }
};

/// LiDAR odometry by PCL's own registration: each scan with a local map of the latest keyframes, from where odometry or
/// constant velocity leads. Scans are deskewed by odometry, without one by constant velocity. A scan that does not fit
/// leaves the pose to the guess.
[[nodiscard]] std::unique_ptr<Method> make_pcl_gicp_method(const MethodInput& input, const PclGicpMethodConfig& config);
[[nodiscard]] std::unique_ptr<Method> make_pcl_ndt_method(const MethodInput& input, const PclNdtMethodConfig& config);

}  // namespace plumbline::slam
