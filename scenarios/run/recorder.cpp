// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/recorder.h"

#include <filesystem>

#include "bim/errors.h"
#include "scenarios/run/ground_truth_recorder.h"

namespace plumbline::scenarios {

namespace {

const std::string& made(const std::string& dir) {
  std::error_code error;
  std::filesystem::create_directory(dir, error);
  if (error) throw EnvironmentError(dir + ": cannot be created: " + error.message());
  return dir;
}

slam::RecordingInfo info_of(const ResolvedScenario& resolved) {
  const slam::LidarModel& model = slam::lidar_model(resolved.world.lidar.model);
  if (model.product == 0)
    throw InputError({}, "LiDAR model " + std::string(model.name) +
                             " sends no packets to record; vlp16, vlp32c or hdl32e would be right");
  slam::RecordingInfo info = slam::recording_info(resolved.scenario.seed, sim::World::calibration(), resolved.prior);
  info.lidar.vertical_offsets = resolved.world.vertical_offsets;
  info.plan = resolved.scenario.building_options;
  return info;
}

}  // namespace

Recorder::Recorder(const std::string& dir, const ResolvedScenario& resolved)
    : dir_(dir), writer_(made(dir), info_of(resolved)) {}

void Recorder::add_bag(const slam::BagProfile& profile, bool with_truth) {
  bag_ = std::make_unique<slam::BagWriter>(dir_ + "/recording.bag", profile, sim::World::calibration());
  truth_in_bag_ = with_truth;
}

void Recorder::add(const sim::WorldFrame& frame) {
  const slam::SensorFrame& sensors = frame.sensors;
  writer_.add(sensors.packets, sensors.odometry, sensors.imu);
  writer_.add(sensors.covariances);
  add_sensor_digests(sensors, digests_);
  if (!bag_) return;
  bag_->add(sensors.scan, sensors.odometry, sensors.imu, sensors.covariances);
  if (!truth_in_bag_) return;
  std::vector<slam::StampedPose> truth;
  for (const sim::TruePose& pose : frame.truth.poses) truth.push_back({pose.stamp, pose.X_WR});
  bag_->add_truth(truth);
}

void Recorder::finish() {
  writer_.finish(sensor_digest_of(digests_));
  if (bag_) bag_->finish();
}

}  // namespace plumbline::scenarios
