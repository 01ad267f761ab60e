// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/errors.h"
#include "bim/geometry/pose.h"

namespace plumbline::sim {

/// "<what> at 12.34 s at (1.00, 2.00, 0.50)".
[[nodiscard]] ScenarioFailure scenario_failure(const std::string& what, double time_s, const Eigen::Vector3d& p_W);

}  // namespace plumbline::sim
