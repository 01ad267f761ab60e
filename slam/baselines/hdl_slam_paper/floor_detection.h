// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "bim/config/visit.h"
#include "bim/geometry/plane.h"

namespace plumbline::slam::hdl {

/// Values of hdl_graph_slam's indoor launch file, but for the sensor's height, which is the calibration's.
struct FloorDetectionConfig {
  bool on = true;
  double clip_m = 0.5;
  int least_points = 256;
  double normal_rad = 0.349;
  int neighbours = 10;
  double distance_m = 0.1;
  double tilt_rad = 0.1745;
  int iterations = 10000;
  double information = 0.1;

  template <class V>
  void visit(V& v) {
    v("on", on, Field{.doc = "tie keyframes to the floor that the first one sees", .basic = true});
    v("clip_m", clip_m, Field{.doc = "distance from the height of the floor up to which points are used", .min = 0.01});
    v("least_points", least_points, Field{.doc = "least points, and least inliers, of a floor", .min = 3});
    v("normal_rad", normal_rad,
      Field{.doc = "largest angle of a point's normal to the vertical", .min = 0.0, .max = 1.6});
    v("neighbours", neighbours, Field{.doc = "neighbours of a point that its normal is of", .min = 3});
    v("distance_m", distance_m, Field{.doc = "largest distance of an inlier", .min = 1e-3});
    v("tilt_rad", tilt_rad, Field{.doc = "largest tilt of a floor in the robot's frame", .min = 0.0, .max = 1.6});
    v("iterations", iterations, Field{.doc = "most samples of RANSAC", .min = 1, .max = 1000000});
    v("information", information, Field{.doc = "information of a floor edge", .unit = "1/rad², 1/m²", .min = 1e-9});
  }
};

/// The floor under a robot whose base is height_m above it, as a plane in R with its normal up: RANSAC on points about
/// that height whose normals are upright. Nothing where there are too few.
[[nodiscard]] std::optional<Plane> detect_floor(const std::vector<Eigen::Vector3d>& points_R, double height_m,
                                                const FloorDetectionConfig& config);

}  // namespace plumbline::slam::hdl
