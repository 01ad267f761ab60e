// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "slam/io/method.h"

namespace plumbline::slam {

/// Stands in for missing odometry: before each scan the method gets a prediction that the motion between its last two
/// poses continues, for three such steps at most. Its own odometry priors must be off, for this is no measurement.
[[nodiscard]] std::unique_ptr<Method> with_constant_velocity(std::unique_ptr<Method> method);

}  // namespace plumbline::slam
