// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/lidar_odometry/lidar_odometry_method.h"

#include "bim/digest/digest.h"
#include "slam/io/stopwatch.h"
#include "slam/odometry/front_end.h"
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
      : dead_reckoning_(config.kind == OdometryKind::legs),
        calibration_(input.calibration),
        front_end_(config, input.calibration, input.has_odometry),
        map_(map) {}

  void on_odometry(const Odometry& odometry) override {
    if (dead_reckoning_) motion_.add(odometry);
    front_end_.on_odometry(odometry);
  }

  [[nodiscard]] Output on_scan(const Scan& scan) override {
    Output output;
    output.stamp = scan.stamp;
    Stopwatch stopwatch;
    DeskewedScan deskewed = dead_reckoning_ ? deskew(scan, motion_, calibration_) : front_end_.deskewed(scan);
    output.times.push_back({"deskew", stopwatch.cpu_ms()});
    output.digests.push_back({"deskew", digest(deskewed)});

    stopwatch.restart();
    const Registration registration =
        dead_reckoning_ ? dead_reckoning(motion_.at(scan.stamp)) : front_end_.track(scan, deskewed);
    output.times.push_back({"odometry", stopwatch.cpu_ms()});
    output.digests.push_back(
        {"odometry",
         Digest().add(registration.X_MR).add(registration.matched).add(registration.degenerate_directions).value()});

    if (dead_reckoning_) motion_.forget_before(scan.stamp);
    output.X_FR = registration.X_MR;
    if (registration.lost) output.state = State::lost;
    output.degenerate_directions = registration.degenerate_directions;
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
  bool dead_reckoning_;  ///< by leg odometry alone, in its own frame
  Calibration calibration_;
  MotionBuffer motion_;
  FrontEnd front_end_;
  MapCloudRecorder map_;
  std::vector<StampedPose> trajectory_;
};

}  // namespace

std::unique_ptr<Method> make_lidar_odometry_method(const MethodInput& input, LidarOdometryConfig config,
                                                   const MapCloudConfig& map) {
  config.vgicp.odometry_prior &= input.has_odometry;
  config.vgicp.tilt_prior &= input.has_odometry;
  return std::make_unique<LidarOdometryMethod>(input, config, map);
}

}  // namespace plumbline::slam
