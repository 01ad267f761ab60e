// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/io/method.h"

namespace plumbline::slam::synthetic {

/// What a method is told of the synthetic robot.
[[nodiscard]] MethodInput robot();

/// Largest distances from the truth of the poses that a method gives, the first one taken as true, m.
struct WorstError {
  double m = 0.0, across_m = 0.0, height_m = 0.0;
};
/// Over that time in the corridor house, LiDAR alone. Every scan must get a pose, then and at the end.
[[nodiscard]] WorstError worst_in_house(Method& method, double duration_s, bool rings = true);

}  // namespace plumbline::slam::synthetic
