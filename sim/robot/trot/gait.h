// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/robot/trot/state.h"
#include "sim/robot/trot/trot_config.h"

namespace plumbline::sim {

/// Inputs of the choice between standing and trotting.
struct GaitDemand {
  bool still = true;          ///< commanded to stand, and nearly standing
  bool disturbed = false;     ///< must step to stay upright
  double period_scale = 1.0;  ///< of this stride
  bool slow_gait = false;     ///< begins and ends when all four feet are due on the ground
};

/// The trot's clock, docs/methods/robot.md: diagonal pairs half a period apart.
class Gait {
 public:
  explicit Gait(const GaitConfig& config) : config_(config) {}

  void update(const GaitDemand& demand, double dt);

  [[nodiscard]] bool standing() const { return standing_; }
  [[nodiscard]] bool slow_gait() const { return slow_gait_; }
  [[nodiscard]] bool scheduled_stance(std::size_t leg) const;
  /// Part of the swing that is over, in [0, 1); only in swing.
  [[nodiscard]] double swing_progress(std::size_t leg) const;
  [[nodiscard]] double since_stance_start_s(std::size_t leg) const;
  [[nodiscard]] double until_stance_end_s(std::size_t leg) const;
  [[nodiscard]] double stance_s() const { return duty_ * period_s_; }
  [[nodiscard]] double swing_s() const { return (1.0 - duty_) * period_s_; }

 private:
  [[nodiscard]] double leg_phase(std::size_t leg) const;
  [[nodiscard]] bool all_in_stance(double duty) const;

  GaitConfig config_;
  bool standing_ = true;
  double phase_ = 0.0;
  bool slow_gait_ = false;
  double duty_ = config_.duty;
  double period_s_ = config_.period_s;
  double still_s_ = 0.0;
};

}  // namespace plumbline::sim
