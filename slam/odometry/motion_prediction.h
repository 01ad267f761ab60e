// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <deque>
#include <optional>

#include "bim/geometry/pose.h"
#include "slam/io/records.h"

namespace plumbline::slam {

/// R's next step from those that scan matching found, where nothing measures it. A vehicle goes on as it last did; a
/// trotting body shakes, and its last step says less than the mean of some. Which of them holds is measured, for
/// translations and rotations apart: the one that was nearest of late.
class MotionPrediction {
 public:
  /// R's step over the time dt > 0.
  void add(const Pose& step, Nanoseconds dt);
  /// Nothing before the first step. Farther ahead than three of the last steps noise dominates: no farther, but for the
  /// way of a vehicle, up to the time in which it would stop at 2 m/s^2.
  [[nodiscard]] std::optional<Pose> over(Nanoseconds dt) const;
  /// Root mean square error of such predictions of late, translation in m and rotation in rad.
  [[nodiscard]] double sigma_m() const;
  [[nodiscard]] double sigma_rad() const;
  /// Speed of late in m/s, 0 before the first step.
  [[nodiscard]] double speed_mps() const;
  void clear() { *this = MotionPrediction(); }

 private:
  static constexpr std::array<std::size_t, 3> windows = {1, 4, 12};  ///< steps whose mean predicts

  struct Rate {
    Vector6d per_s = Vector6d::Zero();  ///< (rho, phi) of the step, divided by its time
    Nanoseconds dt = 0;
  };

  [[nodiscard]] Vector6d mean(std::size_t window) const;

  std::deque<Rate> rates_;                                                       ///< newest last
  std::array<double, windows.size()> translation_errors_{}, rotation_errors_{};  ///< squared, of late
};

}  // namespace plumbline::slam
