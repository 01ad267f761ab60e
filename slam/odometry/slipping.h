// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/odometry/health.h"
#include "slam/registration/registration.h"

namespace plumbline::slam {

/// Tells feet and wheels that slip from robots that are pushed and from faces that move. Where odometry's step is not
/// the one that the motion before let expect, the scan is registered without it, too.
class SlipWatch {
 public:
  /// Whether odometry's step is worth that. continued: of scan matching, with what such predictions were off by of
  /// late.
  [[nodiscard]] bool doubts(const Pose& odometry_step, const ExpectedMotion& continued) const;
  /// Whether the scan, registered without odometry, shows that the motion went on: it holds all directions, matches as
  /// usual and leads near to where the motion would have, far from where odometry does. A push shows in both. Where
  /// faces begin to move it is odometry that goes on as before.
  [[nodiscard]] bool shows_slip(const Registration& alone, const Pose& last_X_MR, const Pose& odometry_step,
                                const ExpectedMotion& continued, double usual_matched);
  /// A scan whose odometry was not doubted.
  void trust() { slipping_ = false; }

 private:
  bool slipping_ = false;  ///< at the last scan: it may go on
};

/// The sample of an odometry that has no valid step: `step` with this deviation is expected in its place.
[[nodiscard]] OdometrySample without_step(const OdometrySample& odometry, const Pose& step, double sigma_m);
/// The scan where the robot's motion during it was off by `twist` per second, see correct_motion().
[[nodiscard]] DeskewedScan corrected_by(DeskewedScan scan, const Vector6d& twist);

}  // namespace plumbline::slam
