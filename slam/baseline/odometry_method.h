// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "slam/io/method.h"
#include "slam/odometry/map_cloud.h"

namespace plumbline::slam {

struct OdometryMethodConfig {
  MapCloudConfig map;
  template <class V>
  void visit(V& v) {
    v("map", map);
  }
};

/// Dead reckoning: M is O, the pose is the leg odometry's at the scan's stamp; the map is the deskewed scans put there.
[[nodiscard]] std::unique_ptr<Method> make_odometry_method(const MethodInput& input);

}  // namespace plumbline::slam
