// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "slam/io/records.h"
#include "slam/registration/registration.h"

namespace plumbline::slam {

/// How far from where it is believed to be a robot may have gone while nothing measured its way: standard deviations in
/// m. Scans that fit take back what came in while none did, since the map is of before; nothing takes back what came in
/// before a map that began meanwhile, nor what a map drifted by that was built on the way.
class UnmeasuredWay {
 public:
  /// limit_m: from which on the robot is not known to be where it is believed to be.
  explicit UnmeasuredWay(double limit_m) : limit_m_(limit_m) {}

  /// What steps over dt were off of late by what the motion before let expect, m: the carrier's accelerations. Before
  /// the first, the most is assumed.
  void measure_acceleration(double sigma_m, Nanoseconds dt);
  /// A scan that fits the map and tells the whole pose. as_usual: it fits as well as scans do, so that it is in its
  /// place.
  void add_measured(Nanoseconds dt, bool as_usual);
  /// A scan that fits, but leaves some direction open: the map drifts with the robot.
  void add_open(Nanoseconds dt);
  /// A scan that does not fit, after which the robot is believed to have gone on as before ...
  void add_continued(Nanoseconds dt) { open_s_ += seconds(dt); }
  /// ... or where it was, although it went at this speed.
  void add_frozen(Nanoseconds dt, double speed_mps);
  /// A scan that fits, but so far from what was expected, and so much less than usual, that it may fit elsewhere as
  /// well: by this way. What is mapped from here on goes with it.
  void add_doubtful(double way_m) { doubt_m_ = std::max(doubt_m_, way_m); }
  /// Later scans show that such scans were in their place.
  void settle_doubt() { doubt_m_ = 0.0; }
  /// A new map begins here.
  void begin_map();
  /// A scan that is placed against an earlier one, when this was `then`: it is known as well as that one was.
  void measure_from(const UnmeasuredWay& then);
  /// Something outside, as a loop closure, says where the map is.
  void locate_map() { map_m_ = doubt_m_ = 0.0; }

  /// Of the way gone unmeasured that may still be made up for.
  [[nodiscard]] double open_m() const;
  [[nodiscard]] bool lost() const { return open_m() > limit_m_; }
  /// Whether the place of the map itself is not known.
  [[nodiscard]] bool displaced() const { return map_m_ > limit_m_ || is_doubtful(); }
  /// Whether that is because of doubtful scans on the present map.
  [[nodiscard]] bool is_doubtful() const { return doubt_m_ > limit_m_; }

 private:
  /// What a robot or person accelerates by in passing: at least, since one that goes evenly may stop, and at most;
  /// assumed.
  static constexpr double least_mps2 = 0.6, most_mps2 = 2.0;

  double limit_m_;
  double acceleration_mps2_ = most_mps2;
  double open_s_ = 0.0;    ///< time without a measurement that was not yet made up for
  double frozen_m_ = 0.0;  ///< way gone while the robot was believed to stand
  double map_m_ = 0.0;
  double doubt_m_ = 0.0;  ///< by which doubtful scans on the present map may be off
};

/// A step but for what nothing measured of it, which is as expected: a match that slid there would go on sliding.
[[nodiscard]] Pose measured_part(const Registration& result, const Pose& step, const Pose& expected);

}  // namespace plumbline::slam
