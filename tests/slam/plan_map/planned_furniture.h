// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "bim/plan/plan.h"

namespace plumbline::slam::synthetic {

/// Adds a box from corner `low` to corner `high` (W) to the furniture of a plan.
void add_furniture(bim::Plan& plan, const Eigen::Vector3d& low, const Eigen::Vector3d& high);

}  // namespace plumbline::slam::synthetic
