// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/trot/gait.h"

#include <algorithm>

namespace plumbline::sim {

namespace {

/// FL and HR step together, FR and HL half a period later.
constexpr PerLeg<double> phase_offset = {0.0, 0.5, 0.5, 0.0};

double wrap_phase(double phase) { return phase >= 1.0 ? phase - 1.0 : phase; }

}  // namespace

double Gait::leg_phase(std::size_t leg) const { return wrap_phase(phase_ + phase_offset[leg]); }

bool Gait::scheduled_stance(std::size_t leg) const { return standing_ || leg_phase(leg) < duty_; }

double Gait::swing_progress(std::size_t leg) const { return (leg_phase(leg) - duty_) / (1.0 - duty_); }

double Gait::since_stance_start_s(std::size_t leg) const { return leg_phase(leg) * period_s_; }

double Gait::until_stance_end_s(std::size_t leg) const { return (duty_ - leg_phase(leg)) * period_s_; }

bool Gait::all_in_stance(double duty) const {
  for (std::size_t leg = 0; leg < leg_count; ++leg)
    if (!standing_ && leg_phase(leg) >= duty) return false;
  return true;
}

void Gait::update(const GaitDemand& demand, double dt) {
  const bool calm = demand.still && !demand.disturbed;
  if (demand.slow_gait != slow_gait_ && all_in_stance(std::min(config_.duty, config_.slow_duty))) {
    slow_gait_ = demand.slow_gait;
    duty_ = slow_gait_ ? config_.slow_duty : config_.duty;
  }
  period_s_ = (slow_gait_ ? config_.slow_period_s : config_.period_s) * demand.period_scale;
  if (standing_) {
    if (calm) return;
    standing_ = false;
    phase_ = 0.0;
    still_s_ = 0.0;
    return;
  }
  phase_ = wrap_phase(phase_ + dt / period_s_);
  still_s_ = calm ? still_s_ + dt : 0.0;
  if (still_s_ > config_.settle_time_s && all_in_stance(duty_)) standing_ = true;
}

}  // namespace plumbline::sim
