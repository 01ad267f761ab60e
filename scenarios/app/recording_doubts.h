// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scenarios/app/mount_check.h"
#include "scenarios/app/odometry_axes.h"
#include "scenarios/app/odometry_clock.h"
#include "scenarios/app/odometry_gaps.h"
#include "scenarios/app/recording_summary.h"
#include "scenarios/app/scan_gaps.h"
#include "scenarios/run/record.h"

namespace plumbline::scenarios {

/// What of the records that a method got, and of its answer beside them, a user should know.
class RecordingDoubts {
 public:
  void add(const slam::SensorFrame& frame);
  [[nodiscard]] const ScansRead& scans() const { return scans_; }
  /// Sentences for the user. `record` has the times of the frames; `mount_RL` is the rotation of the mount.
  [[nodiscard]] std::vector<std::string> warnings(const MethodRecord& record, const Eigen::Quaterniond& mount_RL,
                                                  bool with_odometry) const;

 private:
  ScansRead scans_;
  ScanGaps scan_gaps_;
  OdometryGaps odometry_gaps_;
  OdometryAxes axes_;
  OdometryClock clock_;
  MountCheck mount_;
};

}  // namespace plumbline::scenarios
