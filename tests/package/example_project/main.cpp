// SPDX-License-Identifier: Apache-2.0
// A testbench with a method of its own. Every command of the program knows it:
//   my_testbench run short.yaml --method gyro_legs,odometry
#include <memory>

#include "scenarios/app/program.h"
#include "slam/io/method.h"

namespace {

using namespace plumbline;

/// Dead reckoning with the steps of the legs and the heading of the gyro: feet slip when the robot turns, and a gyro
/// does not. M stands where the robot starts.
class GyroLegs final : public slam::Method {
 public:
  /// Adds up the turn about the vertical; the legs' estimate says which way is up.
  void on_imu(const slam::Imu& imu) override {
    const double dt = last_imu_ == 0 ? 0.0 : slam::seconds(imu.stamp - last_imu_);
    turned_ += dt * (X_OR_.q * imu.angular_velocity_R).z();
    last_imu_ = imu.stamp;
  }

  /// A step of the legs, turned by what gyro and legs have come to differ in heading: X_MR = X_MO * X_OR for each step.
  void on_odometry(const slam::Odometry& odometry) override {
    const Pose X_OR = odometry.X_OR;
    if (started_) {
      yaw_MO_ = wrap_angle(yaw_MO_ + turned_ - wrap_angle(X_OR.yaw() - X_OR_.yaw()));
      const Pose R_MO = Pose::from_xyz_yaw(Eigen::Vector3d::Zero(), yaw_MO_);
      X_MR_ = {R_MO.q * X_OR.q, X_MR_.t + R_MO * (X_OR.t - X_OR_.t)};
    }
    X_OR_ = X_OR;
    turned_ = 0.0;
    started_ = true;
  }

  slam::Output on_scan(const slam::Scan& scan) override {
    slam::Output output;
    output.stamp = scan.stamp;
    output.X_FR = X_MR_;
    trajectory_.push_back({scan.stamp, X_MR_});
    return output;
  }

  slam::Estimate finish() override {
    slam::Estimate estimate;
    estimate.trajectory = trajectory_;
    return estimate;
  }

 private:
  Pose X_OR_, X_MR_;
  double yaw_MO_ = 0.0;  ///< heading of O in M, rad
  double turned_ = 0.0;  ///< by the gyro, since the last step, rad
  slam::Nanoseconds last_imu_ = 0;
  bool started_ = false;
  std::vector<slam::StampedPose> trajectory_;
};

}  // namespace

int main(int argc, char** argv) {
  return scenarios::run_program(argc, argv,
                                {{.name = "gyro_legs",
                                  .summary = "steps of the legs, heading of the gyro",
                                  .needs_plan = false,
                                  .make = [](const slam::MethodInput&) { return std::make_unique<GyroLegs>(); }}});
}
