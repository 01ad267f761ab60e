// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "slam/io/records.h"

namespace plumbline::slam {

/// Whether a spinning LiDAR's clouds come with the robot's motion already undone, as many drivers and data sets give
/// them: deskewing them again would bend them. A head turns evenly, so the azimuth of a raw return is linear in its
/// time; a return that was moved by the way v (t - t0) is off by that way, seen across from its range. Regression of
/// azimuths on 1, t and both parts of that: the coefficient of v t is 0 for raw clouds and 1 for compensated ones.
class CompensationTest {
 public:
  /// velocity_L: of the sensor in its own axes during the scan, m/s. Scans of sensors that do not turn evenly, and
  /// those of a robot that hardly moves, tell nothing.
  void add(const Scan& scan, const Eigen::Vector3d& velocity_L);
  /// False until it is known.
  [[nodiscard]] bool compensated() const;
  /// More scans would tell nothing new.
  [[nodiscard]] bool is_settled() const;

 private:
  double coefficient_ = 0.0;  ///< mean, weighted by information
  double information_ = 0.0;  ///< 1 / variance
};

}  // namespace plumbline::slam
