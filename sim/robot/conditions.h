// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "bim/random/stream.h"
#include "sim/robot/model.h"

namespace plumbline::sim {

/// Pushes against the base: horizontal, of any direction, constant while they last; docs/methods/robot.md.
struct PushConfig {
  double min_n = 0.0;    ///< N, uniform from here
  double max_n = 0.0;    ///< to here; 0: no pushes
  double every_s = 6.0;  ///< one in each such span; two follow each other after 2/3 to 4/3 of it
  double duration_s = 0.15;
  bool on_stairs = false;  ///< also in the slow gait of stairs
};

/// Disturbances of walking, unknown to the gait controller.
struct Conditions {
  double friction = ModelConfig().friction;  ///< sliding, of the robot on everything
  double terrain_noise_m = 0.0;              ///< height of the highest plate on the floor; 0: none
  PushConfig pushes;
};

/// The pushes of a run, addressed by physics step.
class Pushes {
 public:
  /// step_s: of the physics.
  Pushes(const PushConfig& config, double step_s, Seed seed);

  /// Force on the base at a step (from 0 on), N in W.
  [[nodiscard]] Eigen::Vector2d force_W(std::int64_t step) const;

 private:
  PushConfig config_;
  std::int64_t span_steps_;
  std::int64_t push_steps_;
  Stream stream_;
};

}  // namespace plumbline::sim
