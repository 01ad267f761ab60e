// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>

#include "slam/odometry/front_end.h"
#include "slam/odometry/motion_prediction.h"
#include "slam/plan_method/coarse_view.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

/// R in O from scan to scan: by odometry, and by scan matching where odometry is silent, stands still while the robot
/// does not, goes on while the robot stands, as with wheels that spin, or jumps, as where feet slip. Whoever localizes
/// by odometry alone follows it wherever it stops.
class WatchedOdometry {
 public:
  explicit WatchedOdometry(const Calibration& calibration) : calibration_(calibration) {}

  struct Tracked {
    Pose X_OR;
    bool is_way_known = true;              ///< from the scan before: false where neither of both measures it
    std::optional<DeskewedScan> deskewed;  ///< by scan matching, where that gave the pose
  };
  /// Of the next scan. late: the clock offset of odometry that `motion` undoes.
  [[nodiscard]] Tracked track(const Scan& scan, const MotionBuffer& motion, Nanoseconds late);
  /// Whether scan matching gave the pose of the last scan.
  [[nodiscard]] bool is_by_scans() const { return by_scans_.has_value(); }

 private:
  /// Scan matching from a scan on at which R was X_OR.
  struct Matching {
    FrontEnd front_end;
    Pose X_OM;
    Pose X_OR;  ///< by odometry where it began
    bool began = false;
  };
  struct Seen {
    Scan scan;
    Pose X_OR;
    CoarseView view;
  };
  struct Step {
    Pose step;
    Nanoseconds dt = 0;
  };
  enum class Why { silent, wrong };

  [[nodiscard]] Matching begin() const;
  /// Matches the scan; `X_OR` is where it was if it is the first.
  Registration match(Matching& matching, const Scan& scan, const Pose& X_OR, DeskewedScan& deskewed) const;
  [[nodiscard]] Tracked by_odometry(const Scan& scan, const MotionBuffer& motion);
  [[nodiscard]] Tracked by_scans(const Scan& scan, const MotionBuffer& motion, bool silent);
  /// Whether scans show for a while that the robot went where odometry stands, or stands where it goes; then by_scans_
  /// takes over.
  [[nodiscard]] bool contradicts_scans(const Scan& scan, const Pose& X_OR);
  /// Whether odometry stands, or goes while the view stays as it was: scan matching is worth its time.
  [[nodiscard]] bool is_suspect(const Pose& X_OR);
  /// Whether scans paused before the last one.
  [[nodiscard]] bool is_after_gap() const;
  /// Whether odometry's step to this scan is not the one that the steps before let expect.
  [[nodiscard]] bool is_last_step_unexpected() const;
  /// Puts a scan's pose where scan matching finds it, if that shows that the robot did not go where odometry's last
  /// steps were unexpected.
  void undo_slip(const Scan& scan, const Pose& X_BR, Tracked& by_odometry);
  void watch_return(const Scan& scan, const MotionBuffer& motion, const Pose& X_OR, bool silent);

  Calibration calibration_;
  std::optional<Pose> X_OB_;              ///< of odometry's own frame, which is moved where it takes over again
  std::deque<Seen> recent_;               ///< the last scans whose poses odometry gave
  std::optional<Pose> X_OR_standing_;     ///< where odometry stands
  int standing_ = 0;                      ///< scans
  std::optional<Matching> beside_;        ///< while odometry is suspect
  int beside_apart_ = 0;                  ///< scans in a row that contradict odometry
  MotionPrediction steps_;                ///< of odometry, without the last ones
  std::deque<Step> last_steps_;           ///< one, or those since one was unexpected and slips were undone
  std::optional<Matching> slip_;          ///< since one was
  int undone_ = 0;                        ///< scans since then at which a slip was undone
  std::optional<Pose> X_OB_before_slip_;  ///< before the last of them, until a scan shows that there was none
  Nanoseconds slipped_ = 0;               ///< stamp of the last of them, or of the scan before the first
  std::optional<Matching> by_scans_;      ///< while it replaces odometry
  Why why_ = Why::silent;                 ///< it does
  std::optional<Pose> X_OR_, X_BR_;       ///< at the last scan: the robot's, and odometry's own
  int agreeing_ = 0;                      ///< scans in a row at which odometry and scan matching agree on the step
  double agreed_m_ = 0.0;                 ///< way in them, turns at 1 m/rad
};

}  // namespace plumbline::slam
