// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/method_runner.h"

#include <utility>

namespace plumbline::scenarios {

MethodRunner::MethodRunner(slam::MethodRow row, slam::MethodInput input, Sensors sensors)
    : row_(std::move(row)),
      input_(std::move(input)),
      sensors_(sensors),
      recorder_(MethodChoice{std::string(row_.name), sensors}.label(), row_.needs_plan) {
  if (sensors_ == Sensors::lidar) input_.has_odometry = false;
}

void MethodRunner::on_frame(const slam::SensorFrame& frame) {
  recorder_.on_scan(frame.scan.stamp, [&] { return process(frame); });
}

/// Records by time; at equal times IMU, then odometry, then the scan.
slam::Output MethodRunner::process(const slam::SensorFrame& frame) {
  if (!method_) method_ = row_.make(input_);  // here, so that a method that cannot even start has crashed
  if (sensors_ == Sensors::lidar) return method_->on_scan(frame.scan);
  auto imu = frame.imu.begin();
  for (const slam::Odometry& odometry : frame.odometry) {
    for (; imu != frame.imu.end() && imu->stamp <= odometry.stamp; ++imu) method_->on_imu(*imu);
    method_->on_odometry(odometry);
  }
  for (; imu != frame.imu.end(); ++imu) method_->on_imu(*imu);
  return method_->on_scan(frame.scan);
}

MethodRecord MethodRunner::finish() {
  return recorder_.finish([&] { return method_ ? method_->finish() : slam::Estimate{}; });
}

}  // namespace plumbline::scenarios
