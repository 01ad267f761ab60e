// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "bim/geometry/pose.h"
#include "sim/robot/conditions.h"
#include "sim/robot/ground.h"

namespace plumbline::sim {

/// Velocity asked of the robot in its heading frame.
struct Command {
  double vx = 0.0;                 ///< m/s
  double vy = 0.0;                 ///< m/s
  double yaw_rate = 0.0;           ///< rad/s
  double gait_period_scale = 1.0;  ///< of the nominal period; varied so that the gait does not lock to the sensor
  bool careful = false;            ///< longer on all four feet, as stairs ask for
};

/// What the joints, the IMU and the feet truly did at one physics step; sensors add their noise to it. Forces (touch,
/// accelerometer) are those that led to the state, so they are of its step's beginning, 2 ms earlier.
struct Proprioception {
  std::array<double, 12> q{};                                 ///< joint angles, rad: per leg FL, FR, HL, HR: hx, hy, kn
  std::array<double, 12> qd{};                                ///< rad/s
  std::array<double, 4> touch{};                              ///< foot normal force, N
  Eigen::Vector3d gyro_R = Eigen::Vector3d::Zero();           ///< rad/s
  Eigen::Vector3d accelerometer_R = Eigen::Vector3d::Zero();  ///< m/s^2, includes -g
};

/// Quadruped in MuJoCo with a trot controller; deterministic. One step is 2 ms.
class Robot {
 public:
  static constexpr std::int64_t step_ns = 2'000'000;

  /// Stands the robot at the position and heading of X_WR_start on the ground at or below it (the height of
  /// X_WR_start is only that bound) and lets it settle for 0.5 s; time starts after that. boxes: what is in its way.
  /// seed: of what is random in the conditions.
  Robot(const Pose& X_WR_start, Ground ground, std::vector<CollisionBox> boxes, const Conditions& conditions = {},
        std::uint64_t seed = 0);
  ~Robot();
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;
  Robot(Robot&&) = delete;
  Robot& operator=(Robot&&) = delete;

  /// Advances by one physics step. Throws ScenarioFailure, with time and place, when the robot has fallen, or when more
  /// boxes than the pool holds are within its reach, and InternalError when the physics breaks down.
  void step(const Command& command);

  [[nodiscard]] std::int64_t steps() const;   ///< since the start
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
