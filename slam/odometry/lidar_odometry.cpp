// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/lidar_odometry.h"

#include <algorithm>
#include <utility>

#include "bim/errors.h"

namespace plumbline::slam {

namespace {

/// Any of the scan matchers behind the common face.
template <class Matcher>
class Wrapped final : public LidarOdometry {
 public:
  template <class Config>
  explicit Wrapped(const Config& config) : matcher_(config) {}
  [[nodiscard]] Registration update(const DeskewedScan& scan, const Pose& X_OR) override {
    return matcher_.update(scan, X_OR);
  }

 private:
  Matcher matcher_;
};

class Legs final : public LidarOdometry {
 public:
  explicit Legs(const LidarOdometryConfig& config) : config_(config) {}

  [[nodiscard]] Registration update(const DeskewedScan&, const Pose& X_OR) override {
    Registration result;
    if (started_) {
      const Pose step = X_OR_.inverse() * X_OR;
      const double way_m = std::max(step.t.norm(), least_step_m);
      X_MR_ = X_MR_ * step;
      result.information.diagonal().head<3>().setConstant(1.0 / (config_.legs_m * config_.legs_m * way_m));
      result.information.diagonal().tail<3>().setConstant(1.0 / (config_.legs_rad * config_.legs_rad * way_m));
    }
    started_ = true;
    X_OR_ = X_OR;
    result.X_MR = X_MR_;
    result.matched = 1.0;
    result.converged = true;
    return result;
  }

 private:
  static constexpr double least_step_m = 1e-3;  ///< standing still is not known for certain

  const LidarOdometryConfig config_;
  bool started_ = false;
  Pose X_MR_;
  Pose X_OR_;
};

}  // namespace

std::unique_ptr<LidarOdometry> make_lidar_odometry(const LidarOdometryConfig& config) {
  switch (config.kind) {
    case OdometryKind::vgicp:
      return std::make_unique<Wrapped<VgicpOdometry>>(config.vgicp);
    case OdometryKind::floam:
      return std::make_unique<Wrapped<loam::FloamOdometry>>(config.floam);
    case OdometryKind::aloam:
      return std::make_unique<Wrapped<loam::AloamOdometry>>(config.aloam);
    case OdometryKind::legs:
      return std::make_unique<Legs>(config);
  }
  throw InternalError("no such odometry");
}

}  // namespace plumbline::slam
