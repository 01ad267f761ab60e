// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "bim/geometry/pose.h"
#include "bim/random/stream.h"
#include "sim/robot/conditions.h"
#include "sim/robot/ground.h"
#include "sim/robot/types/command.h"
#include "sim/robot/types/proprioception.h"

namespace plumbline::sim {

/// Quadruped in MuJoCo with a trot controller; deterministic. One step is 2 ms.
class Robot {
 public:
  static constexpr std::int64_t step_ns = 2'000'000;

  /// Stands the robot at the position and heading of X_WR_start on the ground at or below it (the height of
  /// X_WR_start is only that bound) and lets it settle for 0.5 s; time starts after that. boxes: the obstacles.
  /// seed: of what is random in the conditions.
  Robot(const Pose& X_WR_start, Ground ground, std::vector<CollisionBox> boxes, const Conditions& conditions = {},
        Seed seed = 0);
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
