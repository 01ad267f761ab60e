// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "slam/io/method.h"
#include "slam/odometry/lidar_odometry.h"
#include "slam/scan/map_cloud.h"

namespace plumbline::slam {

/// Config of one front end by itself.
template <class FrontEnd>
struct LidarOdometryMethodConfig {
  FrontEnd odometry;
  MapCloudConfig map;
  template <class V>
  void visit(V& v) {
    v("odometry", odometry);
    v("map", map);
  }
};

/// Config of dead reckoning.
struct DeadReckoningConfig {
  MapCloudConfig map;
  template <class V>
  void visit(V& v) {
    v("map", map);
  }
};

/// Odometry and mapping alone: each scan's pose as the front end gives it, never corrected; of kind legs M is O, and
/// the pose is the leg odometry's at the scan's stamp. Without odometry of the robot it assumes constant velocity.
[[nodiscard]] std::unique_ptr<Method> make_lidar_odometry_method(const MethodInput& input, LidarOdometryConfig config,
                                                                 const MapCloudConfig& map);

}  // namespace plumbline::slam
