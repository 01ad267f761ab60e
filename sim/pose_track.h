// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>

#include "bim/geometry/pose.h"
#include "slam/io/records.h"

namespace plumbline::sim {

/// True poses at physics steps, interpolated for the times between them.
class PoseTrack {
 public:
  /// Times must ascend.
  void add(slam::Nanoseconds stamp, const Pose& X_WR);
  /// Interpolated; t must lie between the first and the last pose kept, else InternalError.
  [[nodiscard]] Pose at(slam::Nanoseconds t) const;
  [[nodiscard]] slam::Nanoseconds last_stamp() const { return poses_.back().stamp; }
  /// Drops what is not needed for times from t on.
  void forget_before(slam::Nanoseconds t);

 private:
  struct Stamped {
    slam::Nanoseconds stamp = 0;
    Pose X_WR;
  };
  std::deque<Stamped> poses_;
};

}  // namespace plumbline::sim
