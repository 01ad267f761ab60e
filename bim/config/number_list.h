// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>

#include "bim/config/tree.h"
#include "bim/geometry/plane.h"

namespace plumbline {

/// Values as files list them.
[[nodiscard]] Tree number_list(std::initializer_list<double> values);
[[nodiscard]] Tree number_list(const Eigen::Vector2d& v);
[[nodiscard]] Tree number_list(const Eigen::Vector3d& v);
/// Position and quaternion x, y, z, w.
[[nodiscard]] Tree number_list(const Pose& X);
/// Normal and offset.
[[nodiscard]] Tree number_list(const Plane& plane);

}  // namespace plumbline
