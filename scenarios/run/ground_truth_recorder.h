// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "bim/mesh/mesh.h"
#include "scenarios/run/record.h"
#include "sim/world.h"

namespace plumbline::scenarios {

/// Keeps one truly hit point of each voxel of the building's box, in the order of time.
class SurfaceRecorder {
 public:
  explicit SurfaceRecorder(const bim::BuildingMesh& mesh, double voxel_m = 0.1);
  void add(const sim::ReturnLabels& labels);
  [[nodiscard]] const std::vector<Eigen::Vector3f>& points_W() const { return points_; }

 private:
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  double voxel_m_;
  int element_count_;  ///< from here on ids are of dynamic obstacles, which are no surface of the building
  Eigen::Vector3i count_ = Eigen::Vector3i::Zero();
  std::vector<bool> taken_;
  std::vector<Eigen::Vector3f> points_;
};

/// Adds the digests of what the sensors recorded up to this scan: sim.odometry (with IMU), sim.lidar.
void add_sensor_digests(const slam::SensorFrame& frame, DigestLog& log);
/// One digest of all that the sensors recorded in a run, from a log that holds their digests: RecordingInfo::walk.
[[nodiscard]] std::string sensor_digest_of(const DigestLog& log);

/// Keeps what scoring and replay need of every frame.
class GroundTruthRecorder {
 public:
  explicit GroundTruthRecorder(const bim::BuildingMesh& mesh);
  void observe(const sim::WorldFrame& frame);
  /// Hands over truth and surface. Call once.
  void move_into(RunRecord& record);
  /// Digests of sim.robot, sim.odometry and sim.lidar, in time order.
  [[nodiscard]] const DigestLog& digests() const { return digests_; }

 private:
  SurfaceRecorder surface_;
  std::vector<slam::StampedPose> truth_;
  DigestLog digests_;
};

}  // namespace plumbline::scenarios
