// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "bim/geometry/pose.h"

namespace plumbline::sim {

/// Velocity asked of the robot in its heading frame.
struct Command {
  double vx = 0.0;        ///< m/s
  double vy = 0.0;        ///< m/s
  double yaw_rate = 0.0;  ///< rad/s
};

/// Static box the robot can bump into: pose of its centre, half sizes, m. Robots collide with boxes near them only.
struct CollisionBox {
  int id = 0;  ///< stable order
  Pose X_WB;
  Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5);
};

/// Height of the walkable floor under (x, y) at or below `z_max`, m.
using Terrain = std::function<double(double x, double y, double z_max)>;

/// What the joints, the IMU and the feet truly did at one physics step; sensors add their noise to it.
struct Proprioception {
  std::array<double, 12> q{};     ///< joint angles, rad: per leg FL, FR, HL, HR: hx, hy, kn
  std::array<double, 12> qd{};    ///< rad/s
  std::array<double, 4> touch{};  ///< foot normal force, N
  Eigen::Vector3d gyro_R = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerometer_R = Eigen::Vector3d::Zero();
};

/// Quadruped in MuJoCo with a trot controller; deterministic. One step is 2 ms.
class Robot {
 public:
  static constexpr std::int64_t step_ns = 2'000'000;

  Robot(const Pose& X_WR_start, Terrain terrain, std::vector<CollisionBox> boxes);
  ~Robot();

  /// Advances by one physics step. Throws ScenarioFailure when the robot has fallen.
  void step(const Command& command);

  [[nodiscard]] Pose X_WR() const;            ///< base pose
  [[nodiscard]] Eigen::Vector3d v_W() const;  ///< base velocity, m/s
  [[nodiscard]] Proprioception proprioception() const;
  [[nodiscard]] std::uint64_t digest() const;  ///< of the whole physics state
  [[nodiscard]] static Pose X_RL();            ///< LiDAR mount

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline::sim
