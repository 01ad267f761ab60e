// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

struct mjModel_;
struct mjData_;

namespace plumbline::sim {

/// What the physics model is built with, besides the robot's dimensions; docs/methods/robot.md.
struct ModelConfig {
  double step_s = 0.002;          ///< s
  double friction = 0.8;          ///< sliding, of feet, floor and boxes
  int box_pool = 64;              ///< boxes near the robot that can exist at once
  int plates = 0;                 ///< of the terrain noise that can exist at once
  int constraint_rows_max = 500;  ///< njmax; MuJoCo preallocates its square
  int contacts_max = 120;         ///< nconmax
};

struct ModelDeleter {
  void operator()(mjModel_* model) const;
};
struct DataDeleter {
  void operator()(mjData_* data) const;
};
using ModelPtr = std::unique_ptr<mjModel_, ModelDeleter>;
using DataPtr = std::unique_ptr<mjData_, DataDeleter>;

/// The quadruped, a floor plane, the box pool and the plates as MJCF text. Bodies: base, lidar_mount, then per leg hip,
/// upper and lower; joints and actuators per leg hx, hy, kn; sensors as accelerometer, gyro and
/// attitude of the IMU, angles and rates of the joints, touch of the feet, place and attitude of the LiDAR.
[[nodiscard]] std::string model_xml(const ModelConfig& config);

/// Where in mjData::sensordata the sensors start that are read; the others count in the digest.
struct SensorLayout {
  int accelerometer = 0;
  int touch = 34;
};

/// Compiles a model from text in memory. Throws EnvironmentError with MuJoCo's own message when it is refused.
[[nodiscard]] ModelPtr load_model(const std::string& xml);
[[nodiscard]] DataPtr make_data(const mjModel_& model);

/// Indices of the geoms of the pool and of the plates, ascending.
[[nodiscard]] std::vector<int> pool_geoms(const mjModel_& model, int box_pool);
[[nodiscard]] std::vector<int> plate_geoms(const mjModel_& model, int plates);

/// Moves the floor plane to a height in W.
void place_floor(mjModel_& model, double z_W);

/// Moves a box geom of the world body, in W. Its bounding sphere moves along: without it contacts would be missed.
void place_box(mjModel_& model, int geom, const Eigen::Vector3d& center_W, const Eigen::Vector4d& q_wxyz,
               const Eigen::Vector3d& half);

}  // namespace plumbline::sim
