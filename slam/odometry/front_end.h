// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "slam/odometry/scan_tracker.h"
#include "slam/odometry/start_trial.h"
#include "slam/odometry/sweep_times.h"

namespace plumbline::slam {

/// From raw scans to poses in M: deskewing and LiDAR odometry. Scans without times are tracked as they are and, beside
/// that, with times inferred from their azimuths, until it is known which of both is true.
class FrontEnd {
 public:
  FrontEnd(const LidarOdometryConfig& config, const Calibration& calibration, bool has_odometry);

  void on_odometry(const Odometry& odometry);
  [[nodiscard]] DeskewedScan deskewed(const Scan& scan) const;
  /// Of a scan that was deskewed by deskewed(); `scan` is replaced by one that was deskewed better where that is known.
  [[nodiscard]] Registration track(const Scan& raw, DeskewedScan& scan);
  /// The place of the map is known again, see LidarOdometry.
  void locate_map();
  /// True once it is known that scans come deskewed; they are left as they are from then on.
  [[nodiscard]] bool compensated() const;
  /// Of scans without times: what is known of their sweeps.
  [[nodiscard]] const SweepTimes& sweep_times() const { return sweep_times_; }

 private:
  /// A tracker and the motion that it found to the last scan.
  struct Tracking {
    ScanTracker tracker;
    std::optional<StartTrial> start;  ///< where there is no odometry
    Pose X_MR;
    Pose step;

    [[nodiscard]] Registration track(const Scan& scan, DeskewedScan& deskewed);
  };
  [[nodiscard]] std::unique_ptr<Tracking> tracking(bool inferred_times) const;
  [[nodiscard]] bool uses_times() const { return timed_ && (!as_is_ || sweep_times_.are_inferred()); }
  /// Keeps the scan until the length of a sweep is known; then the records so far are tracked with inferred times, too.
  void begin_trial(const Scan& scan);
  [[nodiscard]] Registration track_both(const Scan& raw, const Scan& timed, DeskewedScan& scan);
  /// After both tracked a scan, of which `used` gave the pose, and the other is used from the next one on.
  void change_tracker(const Registration& used, const Registration& next);

  LidarOdometryConfig config_;
  Calibration calibration_;
  bool has_odometry_;
  std::unique_ptr<Tracking> as_is_;  ///< until it is known that times are to be inferred
  std::unique_ptr<Tracking> timed_;  ///< while that is tried, or known
  Pose X_MT_;                        ///< the frame of the tracker that is used; identity unless a way is not known
  SweepTimes sweep_times_;
  std::deque<Odometry> first_odometry_;  ///< before timed_ began
  std::vector<Scan> first_scans_;
};

}  // namespace plumbline::slam
