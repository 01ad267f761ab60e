// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/ground_truth_recorder.h"

#include <Eigen/Geometry>
#include <cmath>
#include <span>

#include "bim/config/tree.h"
#include "bim/digest/digest.h"
#include "bim/errors.h"
#include "scenarios/metrics/extent.h"
#include "sim/lidar/light.h"

namespace plumbline::scenarios {

namespace {

std::uint64_t digest_of_odometry(const slam::SensorFrame& frame) {
  Digest digest;
  for (const slam::Imu& imu : frame.imu)
    digest.add(imu.stamp).add(imu.angular_velocity_R).add(imu.linear_acceleration_R);
  for (const slam::Odometry& odometry : frame.odometry) digest.add(odometry.stamp).add(odometry.X_OR);
  for (const slam::OdometryCovariance& record : frame.covariances)
    digest.add(record.stamp).add(std::span(record.covariance.data(), 36));
  return digest.value();
}

std::uint64_t digest_of_lidar(const slam::SensorFrame& frame) {
  Digest digest;
  for (const slam::Vlp16Packet& packet : frame.packets) digest.add(packet.stamp).add_bytes(packet.payload);
  digest.add(frame.scan.stamp).add(frame.scan.columns);
  for (std::size_t i = 0; i < frame.scan.size(); ++i)
    if (frame.scan.range_m[i] > 0.0) digest.add(frame.scan.point_L[i]);
  return digest.value();
}

}  // namespace

void add_sensor_digests(const slam::SensorFrame& frame, DigestLog& log) {
  log.push_back({frame.scan.stamp, "sim.odometry", digest_of_odometry(frame)});
  log.push_back({frame.scan.stamp, "sim.lidar", digest_of_lidar(frame)});
}

std::string sensor_digest_of(const DigestLog& log) {
  DigestLog sensors;
  for (const DigestEntry& entry : log)
    if (entry.stage == "sim.odometry" || entry.stage == "sim.lidar") sensors.push_back(entry);
  return hex64(digest_of(sensors));
}

SurfaceRecorder::SurfaceRecorder(const bim::BuildingMesh& mesh, double voxel_m)
    : voxel_m_(voxel_m), element_count_(static_cast<int>(mesh.elements.size())) {
  if (mesh.vertices.empty()) throw InternalError("the as-built mesh is empty");
  check_extent(mesh);
  Eigen::Vector3d high = mesh.vertices.front();
  origin_ = high;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    origin_ = origin_.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  origin_ -= Eigen::Vector3d::Constant(0.5 * voxel_m_);  // faces on round coordinates lie inside voxels, not between
  count_ = ((high - origin_) / voxel_m_).array().floor().cast<int>() + 2;
  taken_.assign(static_cast<std::size_t>(count_.cast<std::int64_t>().prod()), false);
}

void SurfaceRecorder::add(const sim::ReturnLabels& labels) {
  const Eigen::Vector3i last = count_ - Eigen::Vector3i::Ones();
  for (std::size_t i = 0; i < labels.element.size(); ++i) {
    // People and doors are no part of the building; a return by a mirror lies where nothing is.
    if (labels.element[i] < 0 || labels.element[i] >= element_count_) continue;
    if ((labels.path[i] & sim::light_path::mirrored) != 0) continue;
    const Eigen::Vector3d& p = labels.point_W[i];
    const Eigen::Vector3i cell =
        ((p - origin_) / voxel_m_).array().floor().cast<int>().max(0).min(last.array()).matrix();
    const std::int64_t index =
        (static_cast<std::int64_t>(cell.z()) * count_.y() + cell.y()) * static_cast<std::int64_t>(count_.x()) +
        cell.x();
    if (taken_[static_cast<std::size_t>(index)]) continue;
    taken_[static_cast<std::size_t>(index)] = true;
    points_.push_back(p.cast<float>());
  }
}

GroundTruthRecorder::GroundTruthRecorder(const bim::BuildingMesh& mesh) : surface_(mesh) {}

void GroundTruthRecorder::observe(const sim::WorldFrame& frame) {
  digests_.push_back({frame.sensors.scan.stamp, "sim.robot", frame.truth.robot_digest});
  add_sensor_digests(frame.sensors, digests_);
  for (const sim::TruePose& truth : frame.truth.poses)
    if (truth_.empty() || truth.stamp > truth_.back().stamp) truth_.push_back({truth.stamp, truth.X_WR});
  surface_.add(frame.truth.labels);
}

void GroundTruthRecorder::move_into(RunRecord& record) {
  record.truth_W = std::move(truth_);
  record.surface_W = surface_.points_W();
}

}  // namespace plumbline::scenarios
