// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "slam/scan/motion.h"
#include "slam/scan/plane_observation.h"

namespace plumbline::slam {

/// Adds to the planes' covariances what the motion during the scan that deskewing does not know does to them: each is
/// seen at a part of the sweep of its own, so that they are moved and turned against each other, and a long one bends.
void add_motion_covariance(std::span<PlaneObservation> planes, const DeskewedScan& scan);

}  // namespace plumbline::slam
