// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "bim/geometry/pose.h"
#include "slam/io/records.h"
#include "slam/registration/registration.h"

namespace plumbline::slam {

[[nodiscard]] bool has_times(const Scan& scan);

/// Turns that a spinning LiDAR had made at each slot of a scan since its first return, 0 or more, from the azimuths of
/// the returns in the order of the columns. Empty where these do not go round about once.
[[nodiscard]] std::vector<float> turns_at_slots(const Scan& scan);

/// Times of returns that come without: a head turns evenly, so azimuths tell them. They matter only where clouds are
/// raw; those that come deskewed, or of a moment, would be bent by them. Both are tried, and what fits its own map
/// better is true: by the residuals of registration.
class SweepTimes {
 public:
  /// The next scan; in time order.
  void add(const Scan& scan);
  /// True when there is nothing more to try: scans have times, do not spin, or it is known.
  [[nodiscard]] bool is_settled() const { return settled_; }
  /// True while clouds seem to be raw.
  [[nodiscard]] bool are_inferred() const { return inferred_; }
  /// A scan whose times were to be inferred does not spin; many of them settle it.
  void add_not_spinning();
  /// A sweep's part of the time between the last two scans.
  [[nodiscard]] double share_of_step() const;
  /// The scan with inferred times; nothing where it has times, none are to be inferred, or it does not spin.
  [[nodiscard]] std::optional<Scan> with_times(const Scan& scan) const;
  struct Match {
    const Registration& match;
    const Pose& step;  ///< since the scan before
  };
  /// The last scan matched as it is and with inferred times.
  void compare(const Match& as_is, const Match& timed);

 private:
  void add_ratio(const Match& as_is, const Match& timed);

  std::vector<Nanoseconds> intervals_;  ///< of the first scans
  std::optional<Nanoseconds> stamp_;
  Nanoseconds interval_ = 0;  ///< of the last two scans
  Nanoseconds sweep_ = 0;     ///< a turn; 0 until it is known, or where times are known
  int not_spinning_ = 0;
  bool settled_ = false;
  bool inferred_ = false;
  std::optional<Nanoseconds> first_compared_;
  int compared_ = 0;
  double sum_ = 0.0, squares_ = 0.0;  ///< of the residuals' log ratio, positive where times fit better
};

}  // namespace plumbline::slam
