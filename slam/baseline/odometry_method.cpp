// SPDX-License-Identifier: Apache-2.0
#include "slam/baseline/odometry_method.h"

#include "bim/digest/digest.h"
#include "slam/io/stopwatch.h"
#include "slam/odometry/motion.h"

namespace plumbline::slam {

namespace {

class OdometryMethod final : public Method {
 public:
  OdometryMethod(const MethodInput& input, const OdometryMethodConfig& config)
      : calibration_(input.calibration), map_(config.map) {}

  void on_odometry(const Odometry& odometry) override { motion_.add(odometry); }

  [[nodiscard]] Output on_scan(const Scan& scan) override {
    Output output;
    output.stamp = scan.stamp;
    Stopwatch watch;
    const DeskewedScan deskewed = deskew(scan, motion_, calibration_);
    output.times.push_back({"deskew", watch.cpu_ms()});
    output.digests.push_back({"deskew", digest(deskewed)});

    const Pose X_MR = motion_.at(scan.stamp);
    motion_.forget_before(scan.stamp);
    output.X_FR = X_MR;
    output.digests.push_back({"odometry", Digest().add(X_MR).value()});
    trajectory_.push_back({scan.stamp, X_MR});
    map_.add(deskewed, X_MR);
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
  MapCloudRecorder map_;
  std::vector<StampedPose> trajectory_;
};

}  // namespace

std::unique_ptr<Method> make_odometry_method(const MethodInput& input) {
  return std::make_unique<OdometryMethod>(input, config_of<OdometryMethodConfig>(input));
}

}  // namespace plumbline::slam
