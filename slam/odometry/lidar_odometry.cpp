// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/lidar_odometry.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "bim/errors.h"

namespace plumbline::slam {

namespace {

/// The legs' motion from scan to scan.
class Steps {
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

/// The same for those who see more than the legs. Odometry that comes back after a silence, or says more than a robot
/// can do, holds a way that scans have told of: its frame is moved so that the robot is where it was.
class JoinedSteps {
 public:
  struct Step {
    LegsAt legs;
    Pose X;  ///< from the scan before
  };

  [[nodiscard]] Step to(const Pose& X_BR, const DeskewedScan& scan, const OdometryHealth& health) {
    Step step{{X_OB_ ? *X_OB_ * X_BR : X_BR, true}, Pose{}};
    if (last_) {
      step.X = last_->X_OR.inverse() * step.legs.X_OR;
      const bool apart = last_->silent || !health.possible(step.X, scan.stamp - last_->stamp);
      if (apart) {
        X_OB_ = join_frames(last_->X_OR, X_BR);
        step.legs.X_OR = *X_OB_ * X_BR;
        step.X = last_->X_OR.inverse() * step.legs.X_OR;
      }
      step.legs.followed = !apart && !scan.odometry_silent;
    }
    last_ = Last{scan.stamp, step.legs.X_OR, scan.odometry_silent};
    return step;
  }

 private:
  struct Last {
    Nanoseconds stamp = 0;
    Pose X_OR;
    bool silent = false;
  };

  std::optional<Last> last_;
  std::optional<Pose> X_OB_;  ///< of the odometry's own frame, once it was moved
};

/// Any of the scan matchers behind the common face. A scan that does not fit is dead reckoned and not mapped; after
/// many of them the map is begun anew.
template <class Matcher>
class Wrapped final : public LidarOdometry {
 public:
  template <class MatcherConfig>
  Wrapped(const LidarOdometryConfig& config, const MatcherConfig& matcher)
      : config_(config), matcher_(matcher), health_(config.health) {}

  [[nodiscard]] Registration update(const DeskewedScan& scan, const Pose& X_OR) override {
    const auto [legs, step] = steps_.to(X_OR, scan, health_);
    const Nanoseconds dt = scan.stamp - stamp_;
    const bool ready = matcher_.ready();
    Registration result = matcher_.match(scan, legs);
    result.followed = legs.followed;
    // The first scan of a map lies where dead reckoning says.
    result.believed = ready && health_.judge(result, X_MR_.inverse() * result.X_MR, dt);
    if (!result.believed) {
      result.X_MR = X_MR_ * step;
      result.information =
          legs.followed ? reckoned_information(config_, step.t.norm()) : unknown_information(config_.health, dt);
    }
    X_MR_ = result.X_MR;
    stamp_ = scan.stamp;
    matcher_.commit(X_MR_, result.believed || !ready);
    if (!matcher_.ready()) (void)health_.judge(Registration{}, step, 0);  // nothing seen to begin a map with
    if (ready && !result.believed && health_.wants_restart()) matcher_.forget();
    result.lost = health_.lost();
    return result;
  }

 private:
  const LidarOdometryConfig config_;
  Matcher matcher_;
  OdometryHealth health_;
  JoinedSteps steps_;
  Pose X_MR_;
  Nanoseconds stamp_ = 0;
};

class Legs final : public LidarOdometry {
 public:
  explicit Legs(const LidarOdometryConfig& config) : config_(config) {}

  [[nodiscard]] Registration update(const DeskewedScan&, const Pose& X_OR) override {
    Registration result;
    const Pose step = steps_.to(X_OR);
    X_MR_ = X_MR_ * step;
    result.information = reckoned_information(config_, step.t.norm());
    result.X_MR = X_MR_;
    result.matched = 1.0;
    result.converged = true;
    return result;
  }

 private:
  const LidarOdometryConfig config_;
  Steps steps_;
  Pose X_MR_;
};

}  // namespace

Matrix6d reckoned_information(const LidarOdometryConfig& config, double way_m) {
  constexpr double least_step_m = 1e-3;  // standing still is not known for certain
  const double way = std::max(way_m, least_step_m);
  Matrix6d information = Matrix6d::Zero();
  information.diagonal().head<3>().setConstant(1.0 / (config.legs_m * config.legs_m * way));
  information.diagonal().tail<3>().setConstant(1.0 / (config.legs_rad * config.legs_rad * way));
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
      return std::make_unique<Wrapped<VgicpOdometry>>(config, config.vgicp);
    case OdometryKind::floam:
      return std::make_unique<Wrapped<loam::FloamOdometry>>(config, config.floam);
    case OdometryKind::aloam:
      return std::make_unique<Wrapped<loam::AloamOdometry>>(config, config.aloam);
    case OdometryKind::legs:
      return std::make_unique<Legs>(config);
  }
  throw InternalError("no such odometry");
}

}  // namespace plumbline::slam
