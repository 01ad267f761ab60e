// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "slam/io/recordings/recording.h"

namespace plumbline::slam {

/// Writes a recording directory as the records come, in bounded memory.
class RecordingWriter {
 public:
  /// Writes into `dir`, which must exist; packets_per_message is that of the first frame. Throws EnvironmentError.
  RecordingWriter(const std::string& dir, const RecordingInfo& info);
  ~RecordingWriter();
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  /// What came since the frame before: the packets of one message, and the records up to its end.
  void add(std::span<const Vlp16Packet> packets, std::span<const Odometry> odometry, std::span<const Imu> imu);
  /// Of the odometry's records, in their order.
  void add(std::span<const OdometryCovariance> covariances);
  /// Completes all files. RecordingInfo::walk is the one given here.
  void finish(const std::optional<std::string>& walk = std::nullopt);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline::slam
