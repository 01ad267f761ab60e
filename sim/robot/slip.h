// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "bim/random/stream.h"

namespace plumbline::sim {

/// Episodes in which every foot that stands slides over the ground; docs/methods/robot.md.
struct SlipConfig {
  double speed_mps = 0.0;   ///< 0: feet hold
  double duration_s = 0.2;  ///< of an episode
  double every_s = 10.0;    ///< one in each such span; two follow each other after 2/3 to 4/3 of it
};

/// The slips of a run, addressed by physics step. Only the encoders see them: the robot truly walks on as it did.
class Slips {
 public:
  /// step_s: of the physics.
  Slips(const SlipConfig& config, double step_s, Seed seed);

  /// Velocity of the standing feet over the ground at a step, m/s in R, level.
  [[nodiscard]] Eigen::Vector3d velocity_R(std::int64_t step) const;

 private:
  SlipConfig config_;
  std::int64_t span_steps_;
  std::int64_t slip_steps_;
  Stream stream_;
};

}  // namespace plumbline::sim
