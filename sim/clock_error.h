// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "bim/random/stream.h"
#include "slam/io/records.h"

namespace plumbline::sim {

/// The clock of the legs (odometry and IMU) against that of the LiDAR; docs/methods/robot.md.
struct ClockConfig {
  double offset_s = 0.0;  ///< positive: the legs' stamps are late
  double jitter_s = 0.0;  ///< standard deviation of a stamp, cut at three
};

/// The stamps of one kind of records as the legs' clock gives them. They increase, and none is before the first, which
/// is 0. A clock without error gives the true ones.
class StampError {
 public:
  /// lane: of this kind of records, so that kinds jitter independently.
  StampError(const ClockConfig& config, Seed seed, std::uint32_t lane);

  /// Stamp of the record that was truly taken at this physics step and time; none where it would be before the first.
  /// Call in the order of time, from step 0 on.
  [[nodiscard]] std::optional<slam::Nanoseconds> stamp(std::int64_t step, slam::Nanoseconds true_stamp);

 private:
  ClockConfig config_;
  Stream stream_;
  std::uint32_t lane_;
  slam::Nanoseconds last_ = 0;
};

/// How much later than its stamp a record may be taken, ns.
[[nodiscard]] slam::Nanoseconds longest_lead(const ClockConfig& config);

}  // namespace plumbline::sim
