// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/lidar_odometry.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "bim/errors.h"

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

/// The same for scan matchers. After a gap or an implausible step odometry's motion is discarded, since scans have
/// measured it: its frame is moved so that the robot is where it was.
class ContinuousOdometry {
 public:
  struct Step {
    OdometrySample odometry;
    Pose X;  ///< from the scan before
  };

  [[nodiscard]] Step to(const Pose& X_BR, const DeskewedScan& scan, const OdometryHealth& health) {
    Step step{{X_OB_ ? *X_OB_ * X_BR : X_BR, true}, Pose{}};
    if (last_) {
      step.X = last_->X_OR.inverse() * step.odometry.X_OR;
      const bool discontinuous = last_->stale || !health.is_plausible_step(step.X, scan.stamp - last_->stamp);
      if (discontinuous) {
        X_OB_ = join_frames(last_->X_OR, X_BR);
        step.odometry.X_OR = *X_OB_ * X_BR;
        step.X = last_->X_OR.inverse() * step.odometry.X_OR;
      }
      step.odometry.valid = !discontinuous && !scan.odometry_stale;
    }
    last_ = Last{scan.stamp, step.odometry.X_OR, scan.odometry_stale};
    return step;
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

/// Any of the scan matchers behind the common interface. A scan that does not fit is dead reckoned and not mapped;
/// after many of them the map is begun anew.
template <class Matcher>
class GuardedScanMatcher final : public LidarOdometry {
 public:
  template <class MatcherConfig>
  GuardedScanMatcher(const LidarOdometryConfig& config, const MatcherConfig& matcher)
      : config_(config), matcher_(matcher), health_(config.health) {}

  [[nodiscard]] Registration update(const DeskewedScan& scan, const Pose& X_OR) override {
    const auto [odometry, step] = increments_.to(X_OR, scan, health_);
    const Nanoseconds dt = scan.stamp - stamp_;
    const bool ready = matcher_.ready();
    Registration result = matcher_.match(scan, odometry);
    result.odometry_valid = odometry.valid;
    // The first scan of a map is placed by dead reckoning.
    result.accepted = ready && health_.assess(result, X_MR_.inverse() * result.X_MR, dt);
    if (!result.accepted) {
      result.X_MR = X_MR_ * step;
      result.information =
          odometry.valid ? dead_reckoning_information(config_, step.t.norm()) : unknown_information(config_.health, dt);
    }
    X_MR_ = result.X_MR;
    stamp_ = scan.stamp;
    matcher_.commit(X_MR_, result.accepted || !ready);
    if (!matcher_.ready()) (void)health_.assess(Registration{}, step, 0);  // nothing seen to begin a map with
    if (ready && !result.accepted && health_.wants_restart()) matcher_.reset_map();
    result.lost = health_.lost();
    return result;
  }

 private:
  const LidarOdometryConfig config_;
  Matcher matcher_;
  OdometryHealth health_;
  ContinuousOdometry increments_;
  Pose X_MR_;
  Nanoseconds stamp_ = 0;
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
  const double way_m = limits.max_speed_mps * dt_s, turn_rad = limits.max_turn_radps * dt_s;
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
