// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string_view>

#include "slam/baselines/hdl_slam_paper/cloud_matcher.h"
#include "slam/baselines/hdl_slam_paper/floor_detection.h"
#include "slam/baselines/hdl_slam_paper/loop_detector.h"
#include "slam/graph/optimize.h"
#include "slam/io/method.h"
#include "slam/loop/fitness.h"
#include "slam/scan/map_cloud.h"

namespace plumbline::slam {

namespace hdl {

enum class Registration { ndt, gicp };
[[nodiscard]] constexpr std::array<std::string_view, 2> names_of(Registration) { return {"ndt", "gicp"}; }

/// Which returns are used.
struct PrefilterConfig {
  double min_range_m = 0.5;
  double max_range_m = 100.0;
  double voxel_m = 0.1;
  double outlier_m = 0.5;
  int outlier_neighbours = 2;

  template <class V>
  void visit(V& v) {
    v("min_range_m", min_range_m, Field{.doc = "least range of a return that is used", .min = 0.0});
    v("max_range_m", max_range_m, Field{.doc = "largest range of a return that is used", .min = 1.0, .max = 1000.0});
    v("voxel_m", voxel_m, Field{.doc = "voxel size at which a scan is thinned", .min = 0.02, .basic = true});
    v("outlier_m", outlier_m, Field{.doc = "distance within which a point must have neighbours", .min = 0.0});
    v("outlier_neighbours", outlier_neighbours, Field{.doc = "least number of them; 0: none is asked for", .min = 0});
  }
};

struct OdometryConfig {
  Registration registration = Registration::gicp;
  double keyframe_distance_m = 0.25;
  double keyframe_half_angle_rad = 1.0;

  template <class V>
  void visit(V& v) {
    v("registration", registration, Field{.doc = "how a scan is matched with the last keyframe's", .basic = true});
    v("keyframe_distance_m", keyframe_distance_m,
      Field{.doc = "distance walked after which a scan becomes the one to match with", .min = 0.01, .basic = true});
    v("keyframe_half_angle_rad", keyframe_half_angle_rad,
      Field{.doc = "or half of the angle turned, as in the reference", .min = 0.01, .max = 3.2});
  }
};

/// True when a step is so long that a new odometry keyframe is due. The reference takes acos(q.w), half the angle.
[[nodiscard]] bool odometry_keyframe_is_due(const Pose& step, const OdometryConfig& config);

}  // namespace hdl

/// Values of hdl_graph_slam's launch file for indoors (hdl_graph_slam_501) and of its code where that says nothing.
struct HdlSlamPaperConfig {
  hdl::PrefilterConfig prefilter;
  hdl::OdometryConfig odometry;
  hdl::NdtConfig ndt;
  hdl::GicpConfig gicp;
  double keyframe_distance_m = 1.0;
  double keyframe_angle_rad = 2.0;
  /// The reference's least and greatest 0.05 and 0.2 are of the quaternion's vector part: half the angle.
  FitnessConfig weights{.sigma_min_rad = 0.1, .sigma_max_rad = 0.4};
  hdl::FloorDetectionConfig floor;
  hdl::LoopDetectorConfig loop;
  OptimizerConfig optimizer{.max_iterations = 50, .relative_decrease = 1e-6, .huber = 1e6};
  MapCloudConfig map{.spacing_m = 1.0};

  template <class V>
  void visit(V& v) {
    v("prefilter", prefilter);
    v("odometry", odometry);
    v("ndt", ndt);
    v("gicp", gicp);
    v("keyframe_distance_m", keyframe_distance_m,
      Field{.doc = "distance walked after which a keyframe of the graph is made", .min = 0.05, .basic = true});
    v("keyframe_angle_rad", keyframe_angle_rad,
      Field{.doc = "or angle turned after which it is", .min = 0.02, .max = 6.3});
    v("weights", weights);
    v("floor", floor);
    v("loop", loop);
    v("optimizer", optimizer);
    v("map", map);
  }
};

/// The same with the registration that its code has by default, which its authors advise against with 16 rings.
struct HdlSlamPaperNdtConfig : HdlSlamPaperConfig {
  /// Cells of the code's 0.5 m hold too little of a single scan of 16 rings: se1 is lost with them.
  HdlSlamPaperNdtConfig() {
    odometry.registration = hdl::Registration::ndt;
    ndt.cell_m = 1.0;
  }
};

/// HDL graph SLAM [koide2019] with its authors' indoor settings: scans are matched with single keyframes, a graph of
/// keyframes is held by one floor and closed by loops. LiDAR alone: odometry and IMU are not used, scans are not
/// deskewed. LOST where nothing of a scan lies near the keyframe; poses do not depend on it.
[[nodiscard]] std::unique_ptr<Method> make_hdl_slam_paper(const MethodInput& input, const HdlSlamPaperConfig& config);

}  // namespace plumbline::slam
