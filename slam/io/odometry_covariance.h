// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/io/records.h"

namespace plumbline::slam {

/// Covariance that odometry reports: of the motion up to its record of this stamp since the record before, a right
/// increment (rho, phi) in R, m and rad, symmetric to the last bit. The first record has none.
struct OdometryCovariance {
  Nanoseconds stamp = 0;
  Matrix6d covariance = Matrix6d::Zero();
};

}  // namespace plumbline::slam
