// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <deque>

#include "slam/scan/motion.h"

namespace plumbline::slam {

/// How far a pose was off that odometry's last velocity was carried on to, known when the records that were late are
/// there.
class ExtrapolationErrors {
 public:
  /// The pose that odometry gives at a scan; `motion` tells at later scans what it was.
  void add(Nanoseconds stamp, const Pose& X_OR, const MotionBuffer& motion);
  /// Odometry's frame moves.
  void interrupt() { waiting_.clear(); }

  /// Of (x, y, yaw), over about the last 20 scans: m^2 and rad^2.
  [[nodiscard]] Eigen::Matrix3d covariance() const;

 private:
  struct Extrapolated {
    Nanoseconds stamp = 0;
    Pose X_OR;
  };
  std::deque<Extrapolated> waiting_;
  int scans_ = 0;
  double translation_m2_ = 0.0, yaw_rad2_ = 0.0;  ///< mean squares of the errors
};

}  // namespace plumbline::slam
