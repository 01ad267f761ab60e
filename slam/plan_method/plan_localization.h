// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "bim/config/visit.h"
#include "slam/io/method.h"
#include "slam/io/stopwatch.h"
#include "slam/odometry/clock_offset.h"
#include "slam/odometry/compensation.h"
#include "slam/odometry/front_end.h"
#include "slam/particles/particles.h"
#include "slam/plan_map/plan_index.h"
#include "slam/plan_method/corrected_trajectory.h"
#include "slam/plan_method/extrapolation_errors.h"
#include "slam/plan_method/prior_yaw.h"
#include "slam/plan_method/step_changes.h"
#include "slam/plan_method/watched_odometry.h"
#include "slam/scan/map_cloud.h"

namespace plumbline::slam {

/// When a localization in a plan is updated, and what it reports.
struct PlanUpdateConfig {
  double update_m = 0.25;
  double update_rad = 0.2;
  int particles_shown = 500;
  double mass_shown = 0.02;

  template <class V>
  void visit(V& v) {
    v("update_m", update_m, Field{.doc = "distance walked between two updates", .min = 0, .basic = true});
    v("update_rad", update_rad, Field{.doc = "or angle turned between two updates", .min = 0, .basic = true});
    v("particles_shown", particles_shown, Field{.doc = "most particles that an output carries", .min = 1, .max = 500});
    v("mass_shown", mass_shown, share_field("least mass of a hypothesis that an output carries"));
  }
};

struct PlanMethodConfig : PlanUpdateConfig {
  double yaw_drift = prior_yaw_drift;
  PlanIndexConfig index = {};
  double standing_update_s = 0.0;  ///< between scans that follow a robot that stands; 0: none do
  bool scan_times = false;
  bool watch_odometry = false;

  template <class V>
  void visit(V& v) {
    PlanUpdateConfig::visit(v);
    v("yaw_drift", yaw_drift,
      Field{.doc = "rate at which the standard deviation of the prior yaw grows", .unit = "rad/s", .min = 0});
    v("index", index);
    v("scan_times", scan_times,
      Field{.doc = "whether odometry's clock offset is estimated from the rotation between scans, and deskewed scans "
                   "are left as they are"});
    v("watch_odometry", watch_odometry,
      Field{.doc = "whether scan matching replaces odometry that is silent, stands still while scans show motion, or "
                   "jumps where they show none"});
  }
};

/// One scan to localize by.
struct PlanScan {
  DeskewedScan deskewed;
  Pose X_OR;                          ///< odometry at its stamp
  Pose2 u;                            ///< motion since the last update's scan, identity at the first
  Eigen::Quaterniond q_HR;            ///< roll and pitch, from gravity
  double tilt_sigma = 0.0;            ///< of either where scan matching stands in for odometry, rad
  std::optional<double> prior_yaw_I;  ///< the prior yaw propagated by odometry
  double prior_yaw_sigma = 0.0;       ///< rad
  std::uint64_t tick = 0;             ///< counts the updates, from 1
  double silence_s = 0.0;             ///< before it, in which neither scans nor odometry were received; 0: no while
};

/// What all localizations in a plan share: odometry, by scan matching where the robot has none, when a scan is used,
/// the plan in its own frame I, what is reported in W, and the trajectory and map at the end.
class PlanLocalization : public Method {
 public:
  /// Throws InputError when there is no plan, no such storey, or no room in it.
  PlanLocalization(std::string_view name, const MethodInput& input, const PlanMethodConfig& config,
                   const MapCloudConfig& map);

  void on_odometry(const Odometry& odometry) final;
  [[nodiscard]] Output on_scan(const Scan& scan) final;
  /// The trajectory and its map; empty without a correction.
  [[nodiscard]] Estimate finish() override;

 protected:
  /// Uses a scan that is due; its stages go into the output's digests and times.
  virtual void use_scan(const PlanScan& scan, Output& output) = 0;
  /// Whether a robot that stands is to be followed by scans, as its odometry may drift.
  [[nodiscard]] virtual bool follows_standing() const { return false; }
  /// Uses a scan of a robot that has stood since the last scan that was due, standing_update_s after the one before.
  virtual void use_standing_scan(const PlanScan& /*scan*/, Output& /*output*/) {}
  /// Called where the way to a scan is not known: scan matching is lost, or went on from elsewhere. True: the method
  /// starts anew at the next scan, without the prior yaw, which odometry carried on; false: it goes on as it was.
  [[nodiscard]] virtual bool start_anew() { return false; }
  /// Adds state, pose, hypotheses and particles at any scan, due or not.
  virtual void report(const Pose& X_OR, Output& output) = 0;

  [[nodiscard]] const PlanIndex& index() const { return index_; }
  /// Place of a storey of the plan in the index; it is added when it is not there yet.
  [[nodiscard]] int storey_of_plan(int plan_storey);
  [[nodiscard]] const MethodInput& input() const { return input_; }
  /// Odometry at the last scan that was used.
  [[nodiscard]] const std::optional<Pose>& X_OR_update() const { return X_OR_update_; }
  void add_correction(Nanoseconds stamp, const Pose& X_IO) { trajectory_.add_correction(stamp, X_IO); }

  /// Pose of a robot that stands on its storey's floor with roll and pitch from gravity, its sensor at the calibrated
  /// height or another one.
  [[nodiscard]] Pose pose_on_floor(int storey, const Pose2& X_IH, const Eigen::Quaterniond& q_HR) const {
    return pose_on_floor(storey, X_IH, q_HR, input_.calibration.sensor_height_m);
  }
  [[nodiscard]] Pose pose_on_floor(int storey, const Pose2& X_IH, const Eigen::Quaterniond& q_HR,
                                   double sensor_height_m) const;

  [[nodiscard]] bool is_shown(double mass) const { return mass >= config_.mass_shown; }
  /// In W, with the name of its room. covariance: of (x, y, yaw) in I.
  [[nodiscard]] Hypothesis hypothesis_in_W(double mass, int storey, const Pose& X_IR,
                                           const Eigen::Matrix3d& covariance) const;
  /// What the present pose of (x, y, yaw) is off by besides, where scan matching stands in for odometry or odometry is
  /// late; else none.
  [[nodiscard]] Eigen::Matrix3d end_of_sweep_covariance() const {
    return step_changes_.covariance() + extrapolation_.covariance();
  }
  /// As many as an Output may carry, each moved by u.
  void report_particles(const ParticleSet& particles, const Pose2& u, Output& output) const;

 private:
  [[nodiscard]] bool is_due(const Pose& X_OR) const;
  [[nodiscard]] bool is_due_standing(Nanoseconds stamp) const;
  /// How long neither scans nor odometry were received before this scan, s; 0 where nobody can have carried the robot.
  [[nodiscard]] double silence_before(const Scan& scan) const;
  [[nodiscard]] PlanScan prepare_scan(DeskewedScan scan, const Pose& X_OR, double silence_s) const;
  /// R in O by scan matching, for a robot without odometry; the scan is deskewed. O stands on the first floor seen.
  /// Sets whether the way from the scan before is known.
  [[nodiscard]] Pose track(const Scan& raw, DeskewedScan& scan);
  /// R in O by odometry, as long as that can be believed; the scan is deskewed where scan matching stands in. Sets
  /// whether the way from the scan before is known.
  [[nodiscard]] Pose follow(const Scan& raw, std::optional<DeskewedScan>& scan);
  /// By odometry.
  [[nodiscard]] DeskewedScan deskewed(const Scan& scan) const;
  /// Finds out, for the scans that follow, whether they come deskewed and how late odometry is.
  void test_times(const Scan& scan, const Pose& X_OR);
  /// Finds out whether scans without times are raw.
  void try_times(const Scan& scan);

  MethodInput input_;
  PlanMethodConfig config_;
  PlanIndex index_;
  MotionBuffer motion_;
  CompensationTest compensation_;  ///< of scans, where there is odometry
  ClockOffset clock_offset_;       ///< of odometry
  Nanoseconds undone_offset_ = 0;
  SweepTimes sweep_times_;
  std::optional<FrontEnd> time_trial_;      ///< of scans without times, where there is odometry
  ExtrapolationErrors extrapolation_;       ///< of odometry that is late
  std::optional<FrontEnd> lidar_odometry_;  ///< where the robot has no odometry
  std::optional<WatchedOdometry> watched_;  ///< where it has, and a method does not follow it blindly
  std::optional<Eigen::Quaterniond> q_OM_;  ///< of its map's frame, once a floor was seen
  StepChanges step_changes_;                ///< of scan matching
  bool is_way_known_ = true;                ///< from the scan before to this one
  bool is_start_known_ = true;              ///< whether odometry leads back to the first scan
  std::optional<Pose> X_OR_start_, X_OR_update_;
  Nanoseconds used_ = 0;  ///< stamp of the last scan that was used
  std::optional<Nanoseconds> last_scan_;
  std::optional<double> start_s_;  ///< whole second of the first scan
  std::uint64_t tick_ = 0;
  CorrectedTrajectory trajectory_;
  MapCloudConfig map_config_;
  MapCloudRecorder cloud_;  ///< in O until the end
  std::vector<Nanoseconds> cloud_stamps_;
};

/// Records the time since the last stage and starts the next one.
void record_stage(std::string_view stage, Stopwatch& stopwatch, Output& output);

}  // namespace plumbline::slam
