// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/lidar_odometry/lidar_odometry_method.h"

#include "bim/digest/digest.h"
#include "slam/io/stopwatch.h"
#include "slam/odometry/constant_velocity.h"
#include "slam/odometry/lidar_odometry.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

namespace {

/// M is O.
Registration dead_reckoning(const Pose& X_OR) {
  Registration result;
  result.X_MR = X_OR;
  result.matched = 1.0;
  result.converged = true;
  return result;
}

class LidarOdometryMethod final : public Method {
 public:
  LidarOdometryMethod(const MethodInput& input, const LidarOdometryConfig& config, const MapCloudConfig& map)
      : calibration_(input.calibration),
        odometry_(config.kind == OdometryKind::legs ? nullptr : make_lidar_odometry(config)),
        map_(map) {}

  void on_odometry(const Odometry& odometry) override { motion_.add(odometry); }

  [[nodiscard]] Output on_scan(const Scan& scan) override {
    Output output;
    output.stamp = scan.stamp;
    Stopwatch stopwatch;
    const DeskewedScan deskewed = deskew(scan, motion_, calibration_);
    output.times.push_back({"deskew", stopwatch.cpu_ms()});
    output.digests.push_back({"deskew", digest(deskewed)});

    stopwatch.restart();
    const Pose X_OR = motion_.at(scan.stamp);
    const Registration registration = odometry_ ? odometry_->update(deskewed, X_OR) : dead_reckoning(X_OR);
    output.times.push_back({"odometry", stopwatch.cpu_ms()});
    output.digests.push_back({"odometry", Digest().add(registration.X_MR).add(registration.matched).value()});

    motion_.forget_before(scan.stamp);
    output.X_FR = registration.X_MR;
    if (registration.lost) output.state = State::lost;
    trajectory_.push_back({scan.stamp, registration.X_MR});
    if (registration.accepted || trajectory_.size() == 1) map_.add(deskewed, registration.X_MR);
    return output;
  }

  [[nodiscard]] Estimate finish() override {
    Estimate estimate;
    estimate.trajectory = trajectory_;
    estimate.map_F = map_.cloud();
    return estimate;
  }

 private:
  Calibration calibration_;
  MotionBuffer motion_;
  std::unique_ptr<LidarOdometry> odometry_;  ///< null: leg odometry alone
  MapCloudRecorder map_;
  std::vector<StampedPose> trajectory_;
};

}  // namespace

std::unique_ptr<Method> make_lidar_odometry_method(const MethodInput& input, LidarOdometryConfig config,
                                                   const MapCloudConfig& map) {
  config.vgicp.odometry_prior &= input.has_odometry;
  config.vgicp.tilt_prior &= input.has_odometry;
  auto method = std::make_unique<LidarOdometryMethod>(input, config, map);
  if (input.has_odometry) return method;
  return with_constant_velocity(std::move(method));
}

}  // namespace plumbline::slam
