// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "slam/io/method.h"
#include "slam/odometry/clock_offset.h"
#include "slam/odometry/compensation.h"
#include "slam/odometry/lidar_odometry.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

/// Deskewing and LiDAR odometry of scans with the times they have, by odometry's motion or, where there is none, by the
/// scans' own.
class ScanTracker {
 public:
  /// inferred_times: those of scans come from their azimuths, and tell nothing of these.
  ScanTracker(const LidarOdometryConfig& config, const Calibration& calibration, bool has_odometry,
              bool inferred_times = false);

  ScanTracker(const ScanTracker& other);
  ScanTracker(ScanTracker&&) noexcept = default;
  ScanTracker& operator=(const ScanTracker&) = delete;
  ScanTracker& operator=(ScanTracker&&) noexcept = default;
  ~ScanTracker() = default;

  void on_odometry(const Odometry& odometry);
  [[nodiscard]] DeskewedScan deskewed(const Scan& scan) const;
  /// Of a scan that was deskewed by deskewed(); `scan` is replaced by one that was deskewed better where that is known.
  [[nodiscard]] Registration track(const Scan& raw, DeskewedScan& scan);
  /// Right after a scan that began a map, without odometry: as if the robot went at this velocity, in R.
  void assume_velocity(const Eigen::Vector3d& mps);
  /// The place of the map is known again, see LidarOdometry.
  void locate_map() { odometry_->locate_map(); }
  /// True once it is known that scans come deskewed; they are left as they are from then on.
  [[nodiscard]] bool compensated() const { return compensation_.compensated(); }

 private:
  [[nodiscard]] Registration track_alone(const Scan& raw, DeskewedScan& scan);
  /// Of the motion during a scan: what is known of it is its mean over an interval that may be longer.
  [[nodiscard]] TwistSigma twist_sigma(const Scan& scan, bool stale) const;
  void test_compensation(const Scan& raw, const Pose& step, Nanoseconds dt);
  void test_clock(const Scan& raw);
  [[nodiscard]] DeskewedScan deskewed_by(const Scan& scan, const Pose& step, Nanoseconds dt) const;

  Calibration calibration_;
  bool has_odometry_;
  bool inferred_times_;
  MotionBuffer motion_;
  std::unique_ptr<LidarOdometry> odometry_;
  CompensationTest compensation_;
  ClockOffset clock_offset_;  ///< of odometry
  Nanoseconds undone_offset_ = 0;
  Nanoseconds longest_sweep_ = 0;
  std::optional<Nanoseconds> stamp_;  ///< of the last scan
  Pose X_MR_;                         ///< at that scan
  std::optional<Scan> first_;         ///< of a map, until the second came: only then its motion is known
};

}  // namespace plumbline::slam
