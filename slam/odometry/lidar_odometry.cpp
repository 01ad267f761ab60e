// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/lidar_odometry.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "bim/errors.h"
#include "slam/odometry/motion_prediction.h"

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

/// Of an odometry's step in directions that surfaces leave open.
constexpr double measured_sigma_m = 0.004;

/// The same for scan matchers. After a gap or an implausible step odometry's motion is discarded, since scans have
/// measured it: its frame is moved so that the robot is where it was.
class ContinuousOdometry {
 public:
  [[nodiscard]] OdometrySample to(const Pose& X_BR, const DeskewedScan& scan, const OdometryHealth& health,
                                  const std::optional<Pose>& continued) {
    Pose X_OR = X_OB_ ? *X_OB_ * X_BR : X_BR;
    OdometrySample sample;
    if (last_) {
      sample.step = last_->X_OR.inverse() * X_OR;
      const ExpectedStep expected{scan.stamp - last_->stamp, std::nullopt, continued};
      const bool discontinuous = last_->stale || !health.is_plausible_step(sample.step, expected);
      if (discontinuous) {
        X_OB_ = join_frames(last_->X_OR, X_BR);
        X_OR = *X_OB_ * X_BR;
        sample.step = last_->X_OR.inverse() * X_OR;
      }
      sample.valid = !discontinuous && !scan.odometry_stale;
      if (sample.valid) sample.sigma_m = measured_sigma_m;
    }
    sample.q_OR = X_OR.q;
    last_ = Last{scan.stamp, X_OR, scan.odometry_stale};
    return sample;
  }

 private:
  struct Last {
    Nanoseconds stamp = 0;
    Pose X_OR;
    bool stale = false;
  };

  std::optional<Last> last_;
  std::optional<Pose> X_OB_;  ///< of the odometry's own frame, once it was moved
};

/// Standard deviation of a step that goes on as the one before: what a robot or person accelerates by in passing.
double continued_sigma(Nanoseconds dt) {
  constexpr double acceleration_mps2 = 2.0, least_m = 0.002;
  return std::max(least_m, acceleration_mps2 * seconds(dt) * seconds(dt));
}

/// Any of the scan matchers behind the common interface. A scan that does not fit is dead reckoned and not mapped;
/// after many of them the map is begun anew.
template <class Matcher>
class GuardedScanMatcher final : public LidarOdometry {
 public:
  template <class MatcherConfig>
  GuardedScanMatcher(const LidarOdometryConfig& config, const MatcherConfig& matcher)
      : config_(config), matcher_(matcher), health_(config.health) {}

  [[nodiscard]] Registration update(const DeskewedScan& scan, const Pose& X_OR) override {
    const OdometrySample sample = increments_.to(X_OR, scan, health_, continued(scan.stamp));
    Registration result = matcher_.match(scan, sample, health_.usual_matched());
    result.odometry_valid = sample.valid;
    return keep(scan.stamp, std::move(result), sample);
  }

  [[nodiscard]] Registration update_alone(const DeskewedScan& scan, const DeskewAgain& again) override {
    OdometrySample sample{continued_step(scan.stamp), false, continued_sigma(scan.stamp - stamp_), std::nullopt};
    const Pose expected = sample.step;
    Registration result = matcher_.match(scan, sample, health_.usual_matched());
    // A scan deskewed by a motion that it did not make is bent.
    constexpr int most_rounds = 3;
    for (int round = 0; round < most_rounds && matcher_.ready() && again; ++round) {
      sample.step = X_MR_.inverse() * result.X_MR;
      const std::optional<DeskewedAgain> better = again(sample.step);
      if (!better) break;
      if (better->first) begin_anew(*better->first);
      result = matcher_.match(better->scan, sample, health_.usual_matched());
    }
    sample.step = expected;
    result.odometry_valid = false;
    return keep(scan.stamp, std::move(result), sample);
  }

  [[nodiscard]] Pose continued_step(Nanoseconds stamp) const override { return continued(stamp).value_or(Pose{}); }

 private:
  /// Standard deviation of the way gone in directions that nothing measured: a random walk of the speed.
  [[nodiscard]] double unobserved_sigma(Nanoseconds dt) const {
    return continued_sigma(dt) * std::sqrt(std::pow(unobserved_scans_, 3.0) / 3.0);
  }

  [[nodiscard]] std::optional<Pose> continued(Nanoseconds stamp) const { return motion_.over(stamp - stamp_); }

  /// With a first scan in place of the one that began the map.
  void begin_anew(const DeskewedScan& first) {
    matcher_.reset_map();
    (void)matcher_.match(first, {}, 0.0);
    matcher_.commit(X_MR_, true);
  }

  [[nodiscard]] Registration keep(Nanoseconds stamp, Registration result, const OdometrySample& sample) {
    const bool ready = matcher_.ready();
    const Nanoseconds dt = stamp - stamp_;
    const Pose step = X_MR_.inverse() * result.X_MR;
    const ExpectedStep expected{stamp - accepted_stamp_, sample.valid ? std::optional(sample.step) : std::nullopt,
                                continued(stamp)};
    // The first scan of a map is placed by dead reckoning.
    result.accepted = ready && health_.assess(result, step, expected);
    if (!result.accepted) {
      // Nothing measures where a lost robot goes on to.
      result.X_MR = sample.valid || !health_.lost() ? X_MR_ * sample.step : X_MR_;
      result.information = sample.valid ? dead_reckoning_information(config_, sample.step.t.norm())
                                        : unknown_information(config_.health, dt);
    }
    const bool measured = sample.valid || (result.accepted && result.unobserved_directions == 0);
    // One that tells something now and then is a stray: it takes two such scans to make up for one that told nothing.
    unobserved_scans_ = sample.valid || !ready ? 0.0 : std::max(0.0, unobserved_scans_ + (measured ? -0.5 : 1.0));
    if (result.accepted && dt > 0) motion_.add(step, dt);
    if (result.accepted || !ready) accepted_stamp_ = stamp;
    X_MR_ = result.X_MR;
    stamp_ = stamp;
    matcher_.commit(X_MR_, result.accepted || !ready);
    if (!matcher_.ready()) (void)health_.assess(Registration{}, sample.step, expected);  // nothing to begin a map with
    const bool alone_for_long =
        !sample.valid && health_.lost() && stamp - accepted_stamp_ > config_.health.restart_ns();
    if (ready && !result.accepted && (health_.wants_restart() || alone_for_long)) {
      matcher_.reset_map();
      health_.restart();
      motion_.clear();
    }
    result.lost = health_.lost() || unobserved_sigma(dt) > config_.health.max_unobserved_m;
    return result;
  }

  const LidarOdometryConfig config_;
  Matcher matcher_;
  OdometryHealth health_;
  ContinuousOdometry increments_;
  Pose X_MR_;
  MotionPrediction motion_;  ///< from the accepted scans
  Nanoseconds stamp_ = 0;
  Nanoseconds accepted_stamp_ = 0;
  double unobserved_scans_ = 0.0;  ///< more than made up for
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
  [[nodiscard]] Pose continued_step(Nanoseconds) const override { return {}; }

 private:
  const LidarOdometryConfig config_;
  OdometryIncrements increments_;
  Pose X_MR_;
};

}  // namespace

Matrix6d dead_reckoning_information(const LidarOdometryConfig& config, double way_m) {
  constexpr double least_step_m = 1e-3;  // standing still is not known for certain
  const double way = std::max(way_m, least_step_m);
  Matrix6d information = Matrix6d::Zero();
  information.diagonal().head<3>().setConstant(1.0 /
                                               (config.dead_reckoning_sigma_m * config.dead_reckoning_sigma_m * way));
  information.diagonal().tail<3>().setConstant(
      1.0 / (config.dead_reckoning_sigma_rad * config.dead_reckoning_sigma_rad * way));
  return information;
}

Matrix6d unknown_information(const HealthConfig& limits, Nanoseconds dt) {
  constexpr double least_dt_s = 0.01;
  const double dt_s = std::max(seconds(dt), least_dt_s);
  const double way_m = limits.max_acceleration_mps2 * dt_s * dt_s;
  const double turn_rad = limits.max_turn_acceleration_radps2 * dt_s * dt_s;
  Matrix6d information = Matrix6d::Zero();
  information.diagonal().head<3>().setConstant(1.0 / (way_m * way_m));
  information.diagonal().tail<3>().setConstant(1.0 / (turn_rad * turn_rad));
  return information;
}

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
