// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/errors.h"
#include "bim/geometry/pose.h"

namespace plumbline::slam {

/// Coordinates are finite and at most 100,000 km, further than any map grid's origin, and the quaternion is of norm 1
/// within 1 %.
[[nodiscard]] bool plausible(const Pose& X);

/// Takes a pose as a file gives it. Throws InputError at the mark where it is not plausible; makes the quaternion's
/// norm 1 where it is off by more than 1e-9, so that what the simulator wrote comes back to the bit.
[[nodiscard]] Pose checked_pose(const Eigen::Vector3d& t, const Eigen::Quaterniond& q, const Mark& mark);

}  // namespace plumbline::slam
