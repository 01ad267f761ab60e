// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "slam/odometry/scan_tracker.h"

namespace plumbline::slam {

/// A recording may begin in motion, and so may a map that begins anew. Without odometry nothing is known of it: scans
/// are deskewed as if the robot stood, and a search from where it was finds the standstill of what goes along with it.
/// The first scans are tracked again from the velocities at which they correlate with the first one [olson2009]; one
/// from which they match clearly better was the robot's.
class StartTrial {
 public:
  StartTrial(const LidarOdometryConfig& config, const Calibration& calibration)
      : config_(config), calibration_(calibration) {}

  /// A tracker and what it gave for the last scan.
  struct Tracked {
    ScanTracker tracker;
    DeskewedScan scan;
    Registration result;
  };
  /// The next scan and what `tracker` gave for it. The tracker to go on with, where another start was right; its result
  /// tells the pose, but nothing of the step from the last one.
  [[nodiscard]] std::optional<Tracked> add(const Scan& raw, const ScanTracker& tracker, const Registration& result);

 private:
  [[nodiscard]] std::optional<Tracked> better_start() const;
  /// At which later scans correlate with the first one, beside that which was found; in R at the first.
  [[nodiscard]] std::vector<Eigen::Vector3d> other_velocities() const;
  void end();

  LidarOdometryConfig config_;
  Calibration calibration_;
  std::optional<ScanTracker> began_;  ///< after the first of the scans, while a trial is on
  std::vector<Scan> scans_;
  std::vector<Registration> results_;
};

}  // namespace plumbline::slam
