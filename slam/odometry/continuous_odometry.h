// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "bim/geometry/pose.h"
#include "slam/odometry/health.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

/// Of an odometry's step in directions that surfaces leave open.
constexpr double measured_sigma_m = 0.004;

/// Odometry's motion from scan to scan for scan matchers. After a gap or an implausible step it is discarded, since
/// scans have measured it: its frame is moved so that the robot is where it was.
class ContinuousOdometry {
 public:
  /// X_BR: odometry at the scan's stamp, in its own frame. continued: as if the motion before went on.
  [[nodiscard]] OdometrySample to(const Pose& X_BR, const DeskewedScan& scan, const OdometryHealth& health,
                                  const std::optional<ExpectedMotion>& continued);

 private:
  struct Last {
    Nanoseconds stamp = 0;
    Pose X_OR;
    bool stale = false;
    Nanoseconds age = 0;
    std::optional<ExpectedMotion> step;  ///< as if it went on
  };

  std::optional<Last> last_;
  std::optional<Pose> X_OB_;  ///< of the odometry's own frame, once it was moved
};

}  // namespace plumbline::slam
