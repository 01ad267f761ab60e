// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "bim/mesh/mesh.h"
#include "bim/model/building.h"
#include "sim/faults.h"
#include "sim/lidar/lidar.h"
#include "sim/moving/dynamic_obstacles.h"
#include "sim/robot/conditions.h"
#include "sim/robot/sensors.h"
#include "sim/route/pure_pursuit.h"
#include "slam/io/estimate.h"
#include "slam/io/recordings/sensor_frame.h"

namespace plumbline::sim {

struct WorldConfig {
  std::uint64_t seed = 1;
  std::uint32_t part = 0;  ///< of a run that is split, as by a kidnapping: noise differs, biases of the unit stay
  LidarConfig lidar;
  double rpm = 600.0;            ///< of the LiDAR's head, 300 to 1200
  bool vertical_offsets = true;  ///< of the lasers, in the driver's calibration
  OdometryPreset odometry = OdometryPreset::noisy;
  Faults faults;          ///< of time, IMU and feet; the mount's error is in the calibration given to estimators
  Conditions conditions;  ///< friction, terrain noise, pushes
  int storey = 0;
  Eigen::Vector2d start_W = Eigen::Vector2d::Zero();  ///< m
  double start_yaw = 0.0;                             ///< rad
  std::vector<Waypoint> waypoints;  ///< the route, from the start on; fewer than two: stand all the time
  double speed_mps = 0.6;
  double duration_s = 120.0;
  double stand_s = 1.0;  ///< after the end of the route
  std::vector<PersonConfig> people;
  std::vector<SwingDoorConfig> doors;  ///< that move
};

struct TruePose {
  slam::Nanoseconds stamp = 0;
  Pose X_WR;
};

/// What only the simulator knows. It goes to scoring and never to an estimator.
struct GroundTruth {
  std::vector<TruePose> poses;  ///< 100 Hz and, last, at the stamp of the scan
  ReturnLabels labels;          ///< of the scan's returns
  std::uint64_t robot_digest = 0;
};

/// Everything that happened up to and including one scan, since the previous one. Sensor rates: IMU 250 Hz, odometry
/// 100 Hz, whose frame O is the robot's pose at time 0; the scan is decoded from the packets. Stamps of IMU and
/// odometry are those of the legs' clock.
struct WorldFrame {
  slam::SensorFrame sensors;
  GroundTruth truth;
  std::vector<slam::StageTime> times;  ///< CPU time of sim.physics and sim.lidar
};

/// The simulated world: route, gait, physics, sensors. Same config, same frames, bit for bit. The LiDAR does not see
/// the robot itself; people and moving doors are there for the LiDAR only, with element ids from mesh.elements.size().
class World {
 public:
  /// mesh is that of as_built, panes included; both must outlive the world. Throws InputError when the storey does not
  /// exist.
  World(const WorldConfig& config, const bim::Building& as_built, const bim::BuildingMesh& mesh);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;
  World(World&&) = delete;
  World& operator=(World&&) = delete;

  /// Advances to the end of the next LiDAR message. False when the route or the time is done (frame untouched).
  /// Throws ScenarioFailure on a fall or a stall.
  [[nodiscard]] bool next(WorldFrame& frame);
  /// The true calibration, without the mount's error.
  [[nodiscard]] static slam::Calibration calibration();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline::sim
