// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/lidar_odometry.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <type_traits>
#include <utility>

#include "bim/errors.h"
#include "slam/odometry/continuous_odometry.h"
#include "slam/odometry/doubtful_step.h"
#include "slam/odometry/motion_prediction.h"
#include "slam/odometry/slipping.h"
#include "slam/odometry/unmeasured_way.h"

namespace plumbline::slam {

namespace {

/// Odometry's motion from scan to scan.
class OdometryIncrements {
 public:
  [[nodiscard]] Pose to(const Pose& X_OR) {
    const Pose step = started_ ? X_OR_.inverse() * X_OR : Pose{};
    started_ = true;
    X_OR_ = X_OR;
    return step;
  }

 private:
  bool started_ = false;
  Pose X_OR_;
};

/// Standard deviation of a step that goes on as the one before: what a robot or person accelerates by in passing.
double continued_sigma(Nanoseconds dt) {
  constexpr double acceleration_mps2 = 2.0, least_m = 0.002;
  return std::max(least_m, acceleration_mps2 * seconds(dt) * seconds(dt));
}

/// What odometry errs by as a rule: feet and wheels slip by some of their way.
ExpectedMotion expected_of(const OdometrySample& odometry) {
  constexpr double least_m = 0.01, per_m = 0.1, least_rad = 0.01, per_rad = 0.1;
  return {odometry.step, least_m + per_m * odometry.step.t.norm() + odometry.extrapolated_m,
          least_rad + per_rad * log_so3(odometry.step.q).norm() + odometry.extrapolated_rad};
}

/// Any of the scan matchers behind the common interface. A scan that does not fit is dead reckoned and not mapped;
/// after many of them the map is begun anew.
template <class Matcher>
class GuardedScanMatcher final : public LidarOdometry {
 public:
  template <class MatcherConfig>
  GuardedScanMatcher(const LidarOdometryConfig& config, const MatcherConfig& matcher)
      : config_(config), matcher_(matcher), health_(config.health), unmeasured_(config.health.max_unobserved_m) {}

  [[nodiscard]] Registration update(const DeskewedScan& scan, const Pose& X_OR) override {
    OdometrySample sample = increments_.to(X_OR, scan, health_, continued(scan.stamp));
    if (const std::optional<Pose> step = resumed_step(scan, X_OR)) {
      sample.step = *step;
      sample.valid = true;
      sample.sigma_m = measured_sigma_m;
      unmeasured_ = measured_by_odometry_->unmeasured;
    } else if (!sample.valid && started_) {
      sample.step = continued_pose(scan.stamp);
      sample.sigma_m = continued_sigma(scan.stamp - stamp_);
    }
    std::optional<Registration> slipping = match_beside(scan, sample);
    Registration result = slipping ? *std::move(slipping) : matcher_.match(scan, sample, health_.usual_matched());
    result.odometry_valid = sample.valid;
    result = keep(scan.stamp, std::move(result), sample);
    if (sample.valid)
      measured_by_odometry_ = MeasuredByOdometry{stamp_, X_MR_, X_OR, unmeasured_};
    else if (result.accepted || result.began)
      measured_by_odometry_.reset();
    return result;
  }

  [[nodiscard]] Registration update_alone(const DeskewedScan& scan, const DeskewAgain& again) override {
    OdometrySample sample;
    sample.step = continued_pose(scan.stamp);
    sample.valid = false;
    sample.sigma_m = continued_sigma(scan.stamp - stamp_);
    if (continued(scan.stamp)) {
      const OdometryHealth::Reach reach = health_.reach(scan.stamp - accepted_stamp_);
      sample.farthest_m = reach.way_m;
      sample.farthest_rad = reach.turn_rad;
    }
    const Pose expected = sample.step;
    Registration result = matcher_.match(scan, sample, health_.usual_matched());
    const bool from_expected = result.from_expected;  // later rounds start where it led
    // A scan deskewed by a motion that it did not make is bent. What a lost robot did meanwhile is no motion of a scan.
    constexpr int most_rounds = 3;
    for (int round = 0; round < most_rounds && matcher_.ready() && again && moved_stamp_ == stamp_; ++round) {
      sample.step = X_MR_.inverse() * result.X_MR;
      const std::optional<DeskewedAgain> better = again(sample.step);
      if (!better) break;
      if (better->first) begin_anew(*better->first);
      Registration next = matcher_.match(better->scan, sample, health_.usual_matched());
      // A wrong step bends the scan towards a place still farther off, where it matches less: by 15 % on the walk in
      // the duplex that this was chosen on. Less than 5 % is scatter of the match; the corridor lc1 is lost by it.
      constexpr double about_as_much = 0.95;
      if (!better->first && next.matched < about_as_much * result.matched) break;
      result = std::move(next);
      result.deskewed_again = round + 1;
    }
    sample.step = expected;
    result.from_expected &= from_expected;
    result.odometry_valid = false;
    return keep(scan.stamp, std::move(result), sample);
  }

  void assume_velocity(const DeskewedScan& first, const Eigen::Vector3d& mps) override {
    begin_anew(first);
    assumed_mps_ = mps;
  }
  [[nodiscard]] std::unique_ptr<LidarOdometry> clone() const override {
    return std::make_unique<GuardedScanMatcher>(*this);
  }
  void locate_map() override { unmeasured_.locate_map(); }

  [[nodiscard]] Pose continued_step(Nanoseconds stamp) const override { return continued_over(stamp - stamp_); }

 private:
  /// The scan without odometry, where that slips; `sample` has no valid step then.
  [[nodiscard]] std::optional<Registration> match_beside(const DeskewedScan& scan, OdometrySample& sample) {
    const std::optional<ExpectedMotion> motion = continued(scan.stamp);
    // The others do not tell which directions a scan leaves open.
    const bool usable = std::is_same_v<Matcher, VgicpOdometry> && sample.valid && matcher_.ready();
    if (!usable || moved_stamp_ != stamp_ || !motion || !slip_.doubts(sample.step, *motion)) {
      slip_.trust();
      return std::nullopt;
    }
    const Vector6d twist = log_se3(sample.step.inverse() * motion->step) / seconds(scan.stamp - stamp_);
    const OdometrySample none = without_step(sample, motion->step, continued_sigma(scan.stamp - stamp_));
    Registration alone = matcher_.match(corrected_by(scan, twist), none, health_.usual_matched());
    if (!slip_.shows_slip(alone, X_MR_, sample.step, *motion, health_.usual_matched())) return std::nullopt;
    alone.sweep_twist += twist;
    sample = none;
    return alone;
  }
  /// From X_MR_, as if the motion before went on.
  [[nodiscard]] std::optional<ExpectedMotion> continued(Nanoseconds stamp) const {
    const std::optional<Pose> step = motion_.over(stamp - moved_stamp_);
    if (!step) return std::nullopt;
    // Beside what predictions erred by of late: whoever stops or turns, begins to.
    constexpr double acceleration_mps2 = 0.5, turn_acceleration_radps2 = 1.0;
    const double dt_s = seconds(stamp - moved_stamp_);
    return ExpectedMotion{*step, motion_.sigma_m() + acceleration_mps2 * dt_s * dt_s,
                          motion_.sigma_rad() + turn_acceleration_radps2 * dt_s * dt_s};
  }
  [[nodiscard]] Pose continued_pose(Nanoseconds stamp) const { return continued_over(stamp - moved_stamp_); }
  [[nodiscard]] Pose continued_over(Nanoseconds dt) const {
    if (const std::optional<Pose> step = motion_.over(dt)) return *step;
    return {Eigen::Quaterniond::Identity(), assumed_mps_ * seconds(dt)};
  }

  /// Up to where odometry has measured the way.
  struct MeasuredByOdometry {
    Nanoseconds stamp = 0;
    Pose X_MR, X_OR;
    UnmeasuredWay unmeasured;
  };

  /// Of an odometry that pauses, as one slower than scans does, where no scan has measured the way meanwhile.
  [[nodiscard]] std::optional<Pose> resumed_step(const DeskewedScan& scan, const Pose& X_OR) const {
    if (!measured_by_odometry_ || measured_by_odometry_->stamp == stamp_ || scan.odometry_stale) return std::nullopt;
    const Pose way = measured_by_odometry_->X_OR.inverse() * X_OR;
    const ExpectedStep unknown{scan.stamp - measured_by_odometry_->stamp, std::nullopt, std::nullopt};
    if (!health_.is_plausible_step(way, unknown)) return std::nullopt;
    return X_MR_.inverse() * measured_by_odometry_->X_MR * way;
  }
  /// Whether a map would begin at a pose that odometry will soon know better.
  [[nodiscard]] bool awaits_odometry(Nanoseconds stamp, const OdometrySample& sample) const {
    return measured_by_odometry_ && !sample.valid && stamp - measured_by_odometry_->stamp < config_.health.restart_ns();
  }

  /// With a first scan in place of the one that began the map.
  void begin_anew(const DeskewedScan& first) {
    matcher_.reset_map();
    (void)matcher_.match(first, {}, 0.0);
    matcher_.commit(X_MR_, true);
  }

  [[nodiscard]] Registration keep(Nanoseconds stamp, Registration result, const OdometrySample& sample) {
    const bool ready = matcher_.ready();
    const Nanoseconds dt = stamp - stamp_, moved = stamp - moved_stamp_;
    const Pose step = X_MR_.inverse() * result.X_MR;
    // An earlier keyframe tells what nothing measured since, all of it in one step.
    const ExpectedStep expected{stamp - (result.correlated ? measured_stamp_ : accepted_stamp_),
                                sample.valid ? std::optional(expected_of(sample)) : std::nullopt, continued(stamp)};
    // A handful of surfels tell nothing.
    constexpr int all_directions = 6;
    if (!sample.valid && result.unobserved_directions >= all_directions) result.matched = 0.0;
    const bool as_usual = health_.is_as_usual(result);
    // The first scan of a map is placed by dead reckoning.
    result.accepted = ready && health_.assess(result, step, expected);
    const bool frozen = !result.accepted && !sample.valid && health_.lost();  // nothing measures where it goes on to
    const bool measures = sample.valid || health_.measures();
    if (had_map_) account_for_way(dt, result, {as_usual, sample.valid, frozen || !ready, measures});
    // Where the last scan was in its place, an alias is what another start leads to.
    const bool continues = result.from_expected && accepted_stamp_ == stamp_;
    constexpr int most_steps = 3;  // of the one before; in a longer gap the scene may have become another
    const bool surprises_after_gap = dt / most_steps > dt_ && !OdometryHealth::is_expected_step(step, expected);
    const bool doubtful = surprises_after_gap || health_.is_doubtful(result, step, expected);
    if (had_map_ && result.accepted && !sample.valid && !continues && doubtful) {
      begin_doubt(step, sample.step, surprises_after_gap);
    } else if (doubt_) {
      settle_doubt(result, result.accepted && OdometryHealth::is_expected_step(step, expected));
    }
    if (!result.accepted) {
      result.X_MR = frozen ? X_MR_ : X_MR_ * sample.step;
      result.information = sample.valid ? dead_reckoning_information(config_, sample.step.t.norm())
                                        : unknown_information(config_.health, dt, speed_mps_);
    } else if (!sample.valid) {
      const double sigma_m = std::max(unmeasured_.open_m(), continued_sigma(dt));
      result.information += result.open / (sigma_m * sigma_m);
    }
    if (result.accepted && moved > 0)
      add_motion(result, sample.valid ? step : measured_part(result, step, sample.step), stamp);
    if (result.accepted && result.correlated && result.unobserved_directions == 0)
      measure_from_keyframe(result.correlated->keyframe_stamp);
    if (result.accepted && moved > 0 && result.unobserved_directions == 0 && measures)
      unmeasured_.measure_acceleration(motion_.sigma_m(), moved);
    if (!result.accepted && sample.valid && ready && dt > 0) motion_.add(sample.step, dt);
    if (ready) speed_mps_ = motion_.speed_mps();
    const bool begins = !ready && !awaits_odometry(stamp, sample);
    if (result.accepted || begins) accepted_stamp_ = stamp;
    const bool tells_all = (result.unobserved_directions == 0 && measures) || sample.valid;
    if ((result.accepted && tells_all) || begins) measured_stamp_ = stamp;
    X_MR_ = result.X_MR;
    stamp_ = stamp;
    dt_ = dt;
    if (!frozen || begins) moved_stamp_ = stamp;  // where a map begins, a motion does
    result.began = begins;
    matcher_.commit(X_MR_, result.accepted || begins);
    result.began &= matcher_.ready();
    if (result.began) unmeasured_.begin_map();
    if constexpr (requires { matcher_.is_keyframe(); })
      if (matcher_.is_keyframe()) remember_keyframe(stamp);
    had_map_ |= matcher_.ready();
    if (!matcher_.ready()) (void)health_.assess(Registration{}, sample.step, expected);  // nothing to begin a map with
    started_ = true;
    restart_if_lost_for_long(result.accepted || !ready, sample.valid);
    result.lost = health_.lost() || unmeasured_.lost();
    result.displaced = unmeasured_.displaced();
    return result;
  }

  /// Of a scan that was accepted, but may be an alias of the place.
  void begin_doubt(const Pose& step, const Pose& expected, bool after_gap) {
    const bool doubted = unmeasured_.is_doubtful();
    unmeasured_.add_doubtful(surprise_m(step, expected));
    if constexpr (std::is_same_v<Matcher, VgicpOdometry>) {
      const DoubtfulStep::Scan scan{
          X_MR_, step, expected, health_.usual_matched(), health_.usual_residual(), config_.health.sure_share};
      if (after_gap)
        doubt_.reset();
      else if (doubted && doubt_)
        doubt_->add_doubtful(scan);
      else if (!doubted && unmeasured_.is_doubtful())
        doubt_.emplace(matcher_, scan);
    }
  }
  void settle_doubt(const Registration& result, bool fits) {
    if constexpr (std::is_same_v<Matcher, VgicpOdometry>) {
      doubt_->add(matcher_, result.X_MR, fits);
      if (doubt_->is_settled()) unmeasured_.settle_doubt();
    }
    if (!unmeasured_.is_doubtful()) doubt_.reset();
  }

  void add_motion(const Registration& result, const Pose& step, Nanoseconds stamp) {
    const ExpectedStep usual{stamp - accepted_stamp_, std::nullopt, continued(stamp)};
    if (!result.correlated || OdometryHealth::is_expected_step(step, usual)) {
      motion_.add(step, stamp - moved_stamp_);
      return;
    }
    // The step makes up for what was not measured, or for what keyframes are off by; the way since one is a motion.
    motion_.clear();
    if (const Nanoseconds dt = stamp - result.correlated->keyframe_stamp; dt > 0)
      motion_.add(result.correlated->X_KR, dt);
  }

  void remember_keyframe(Nanoseconds stamp) {
    constexpr std::size_t most = 1000;  // more than a local map has
    at_keyframes_.push_back({stamp, unmeasured_});
    if (at_keyframes_.size() > most) at_keyframes_.pop_front();
  }
  void measure_from_keyframe(Nanoseconds stamp) {
    const auto is_it = [&](const AtKeyframe& at) { return at.stamp == stamp; };
    const auto at = std::find_if(at_keyframes_.rbegin(), at_keyframes_.rend(), is_it);
    if (at != at_keyframes_.rend()) unmeasured_.measure_from(at->unmeasured);
  }

  struct Measured {
    bool as_usual, by_odometry, frozen, measures;
  };

  void account_for_way(Nanoseconds dt, const Registration& result, const Measured& measured) {
    if (result.accepted && result.unobserved_directions == 0 && measured.measures) {
      unmeasured_.add_measured(dt, measured.as_usual);
    } else if (!measured.by_odometry) {
      if (result.accepted && measured.measures)
        unmeasured_.add_open(dt);
      else if (measured.frozen)
        unmeasured_.add_frozen(dt, speed_mps_);
      else
        unmeasured_.add_continued(dt);
    }
  }

  void restart_if_lost_for_long(bool accepted, bool odometry_valid) {
    const bool alone_for_long =
        !odometry_valid && health_.lost() && stamp_ - accepted_stamp_ > config_.health.restart_ns();
    if (accepted || !matcher_.ready() || !(health_.wants_restart() || alone_for_long)) return;
    matcher_.reset_map();
    health_.restart();
    motion_.clear();
    assumed_mps_.setZero();
    moved_stamp_ = stamp_;
  }

  const LidarOdometryConfig config_;
  Matcher matcher_;
  OdometryHealth health_;
  UnmeasuredWay unmeasured_;
  std::optional<DoubtfulStep> doubt_;  ///< while unmeasured_ is doubtful, where later scans may settle it
  SlipWatch slip_;
  ContinuousOdometry increments_;
  bool started_ = false;  ///< a scan came ...
  bool had_map_ = false;  ///< ... and one that could begin a map
  Pose X_MR_;
  MotionPrediction motion_;                                ///< from the accepted scans
  Eigen::Vector3d assumed_mps_ = Eigen::Vector3d::Zero();  ///< before there are any
  double speed_mps_ = 0.0;                                 ///< when a map was last there
  Nanoseconds stamp_ = 0, dt_ = 0;                         ///< of the last scan, and since the one before
  Nanoseconds moved_stamp_ = 0;                            ///< of the last scan that X_MR_ was moved at
  Nanoseconds accepted_stamp_ = 0;
  Nanoseconds measured_stamp_ = 0;  ///< of the last scan whose whole motion was measured
  struct AtKeyframe {
    Nanoseconds stamp = 0;
    UnmeasuredWay unmeasured;
  };
  std::deque<AtKeyframe> at_keyframes_;
  std::optional<MeasuredByOdometry> measured_by_odometry_;  ///< nothing once scans have measured the way since
};

class DeadReckoning final : public LidarOdometry {
 public:
  explicit DeadReckoning(const LidarOdometryConfig& config) : config_(config) {}

  [[nodiscard]] Registration update(const DeskewedScan&, const Pose& X_OR) override {
    Registration result;
    const Pose step = increments_.to(X_OR);
    X_MR_ = X_MR_ * step;
    result.information = dead_reckoning_information(config_, step.t.norm());
    result.X_MR = X_MR_;
    result.matched = 1.0;
    result.converged = true;
    return result;
  }

  [[nodiscard]] Registration update_alone(const DeskewedScan&, const DeskewAgain&) override {
    throw InternalError("dead reckoning without odometry");
  }
  void assume_velocity(const DeskewedScan&, const Eigen::Vector3d&) override {}
  [[nodiscard]] std::unique_ptr<LidarOdometry> clone() const override { return std::make_unique<DeadReckoning>(*this); }
  void locate_map() override {}
  [[nodiscard]] Pose continued_step(Nanoseconds) const override { return {}; }

 private:
  const LidarOdometryConfig config_;
  OdometryIncrements increments_;
  Pose X_MR_;
};

}  // namespace

std::unique_ptr<LidarOdometry> make_lidar_odometry(const LidarOdometryConfig& config) {
  switch (config.kind) {
    case OdometryKind::vgicp:
      return std::make_unique<GuardedScanMatcher<VgicpOdometry>>(config, config.vgicp);
    case OdometryKind::floam:
      return std::make_unique<GuardedScanMatcher<loam::FloamOdometry>>(config, config.floam);
    case OdometryKind::aloam:
      return std::make_unique<GuardedScanMatcher<loam::AloamOdometry>>(config, config.aloam);
    case OdometryKind::legs:
      return std::make_unique<DeadReckoning>(config);
  }
  throw InternalError("unknown kind of odometry");
}

}  // namespace plumbline::slam
