// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/lidar_odometry/lidar_odometry_method.h"

#include "bim/digest/digest.h"
#include "slam/odometry/front_end.h"
#include "slam/odometry/odometry_method.h"
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

class LidarOdometryMethod final : public OdometryMethod {
 public:
  LidarOdometryMethod(const MethodInput& input, const LidarOdometryConfig& config, const MapCloudConfig& map)
      : OdometryMethod(map),
        dead_reckoning_(config.kind == OdometryKind::legs),
        calibration_(input.calibration),
        front_end_(config, input.calibration, input.has_odometry) {}

  void on_odometry(const Odometry& odometry) override {
    if (dead_reckoning_)
      motion_.add(odometry);
    else
      front_end_.on_odometry(odometry);
  }

 private:
  [[nodiscard]] DeskewedScan deskewed(const Scan& raw) override {
    return dead_reckoning_ ? deskew(raw, motion_, calibration_) : front_end_.deskewed(raw);
  }

  [[nodiscard]] OdometryAnswer track(const Scan& raw, DeskewedScan& scan) override {
    const Registration found = dead_reckoning_ ? dead_reckoning(motion_.at(raw.stamp)) : front_end_.track(raw, scan);
    if (dead_reckoning_) motion_.forget_before(raw.stamp);
    return {.X_MR = found.X_MR,
            .lost = found.lost || found.displaced,
            .accepted = found.accepted,
            .degenerate_directions = found.degenerate_directions,
            .digest = Digest().add(found.X_MR).add(found.matched).add(found.degenerate_directions).value()};
  }

  bool dead_reckoning_;  ///< by leg odometry alone, in its own frame
  Calibration calibration_;
  MotionBuffer motion_;
  FrontEnd front_end_;
};

}  // namespace

std::unique_ptr<Method> make_lidar_odometry_method(const MethodInput& input, LidarOdometryConfig config,
                                                   const MapCloudConfig& map) {
  config.vgicp.odometry_prior &= input.has_odometry;
  config.vgicp.tilt_prior &= input.has_odometry;
  return std::make_unique<LidarOdometryMethod>(input, config, map);
}

}  // namespace plumbline::slam
