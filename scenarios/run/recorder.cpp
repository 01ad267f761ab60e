// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/recorder.h"

#include <filesystem>

#include "bim/errors.h"
#include "scenarios/run/ground_truth_recorder.h"
#include "slam/io/bags/building_view.h"
#include "slam/io/recordings/recording.h"

namespace plumbline::scenarios {

namespace {

const std::string& made(const std::string& dir) {
  std::error_code error;
  std::filesystem::create_directory(dir, error);
  if (error) throw EnvironmentError(dir + ": cannot be created: " + error.message());
  return dir;
}

bool sends_packets(const ResolvedScenario& resolved) {
  return slam::lidar_model(resolved.world.lidar.model).product != 0;
}

slam::RecordingInfo info_of(const ResolvedScenario& resolved, bool to_bag) {
  if (!to_bag && !sends_packets(resolved))
    throw InputError({}, "LiDAR model " + std::string(slam::lidar_model(resolved.world.lidar.model).name) +
                             " sends no packets to record; simulate with --bag, --mcap or --rosbag2 would be right, or "
                             "vlp16, vlp32c or hdl32e");
  slam::RecordingInfo info = slam::recording_info(resolved.scenario.seed, resolved.calibration, resolved.prior);
  info.lidar.vertical_offsets = resolved.world.vertical_offsets;
  info.plan = resolved.scenario.building_options;
  return info;
}

}  // namespace

Recorder::Recorder(const std::string& dir, const ResolvedScenario& resolved, bool to_bag)
    : dir_(dir),
      packets_(sends_packets(resolved)),
      calibration_(resolved.calibration),
      writer_(made(dir), info_of(resolved, to_bag)) {}

void Recorder::add_bag(const slam::BagProfile& profile, bool with_truth, slam::BagFormat format,
                       std::string_view compression) {
  const char* name = format == slam::BagFormat::ros1   ? "recording.bag"
                     : format == slam::BagFormat::mcap ? "recording.mcap"
                                                       : "rosbag2";
  bags_.push_back(std::make_unique<slam::BagWriter>(dir_ + "/" + name, profile, calibration_, format, compression));
  truth_in_bag_ = with_truth;
}

void Recorder::add_building(const ResolvedScenario& resolved) {
  if (bags_.empty()) return;
  const RunBuilding& building = *resolved.building;
  const slam::ros::BuildingView view =
      slam::ros::building_view(building.mesh_as_planned(), *building.plan_as_planned(), resolved.world.storey);
  for (const auto& bag : bags_) bag->add_building(view);
}

void Recorder::add(const sim::WorldFrame& frame) {
  const slam::SensorFrame& sensors = frame.sensors;
  writer_.add(sensors.packets, sensors.odometry, sensors.imu);
  writer_.add(sensors.covariances);
  add_sensor_digests(sensors, digests_);
  std::vector<slam::StampedPose> truth;
  if (truth_in_bag_)
    for (const sim::TruePose& pose : frame.truth.poses) truth.push_back({pose.stamp, pose.X_WR});
  for (const auto& bag : bags_) {
    bag->add(sensors.scan, sensors.odometry, sensors.imu, sensors.covariances);
    bag->add_truth(truth);
  }
}

void Recorder::finish() {
  writer_.finish(sensor_digest_of(digests_));
  for (const auto& bag : bags_) bag->finish();
  if (!packets_) std::filesystem::remove(dir_ + "/" + std::string(slam::recording_files::lidar));  // without a packet
}

}  // namespace plumbline::scenarios
