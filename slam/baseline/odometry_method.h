// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "slam/io/method.h"

namespace plumbline::slam {

/// Dead reckoning: M is O, the pose is the leg odometry's at the scan's stamp; the map is the deskewed scans put there.
[[nodiscard]] std::unique_ptr<Method> make_odometry_method(const MethodInput& input);

}  // namespace plumbline::slam
