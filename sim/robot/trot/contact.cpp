// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/trot/contact.h"

namespace plumbline::sim {

namespace {

void begin_swing(const Eigen::Vector3d& foot_W, LegContact& leg) {
  leg.lifted_off = true;
  leg.lift_off_W = foot_W;
  leg.early = false;
}

void end_swing(const Eigen::Vector3d& foot_W, LegContact& leg) {
  if (!leg.early) leg.last_stance_W = foot_W;
  leg.early = false;
}

void update_leg(const ContactConfig& config, bool swing, double progress, double touch, bool on_ground,
                const Eigen::Vector3d& foot_W, LegContact& leg) {
  leg.contact = leg.contact ? touch >= config.off_n : touch > config.on_n;
  leg.lifted_off = false;
  if (swing && !leg.scheduled_swing) begin_swing(foot_W, leg);
  if (!swing && leg.scheduled_swing) end_swing(foot_W, leg);
  leg.scheduled_swing = swing;
  if (swing && !leg.early && leg.contact && progress > config.early_after && on_ground) {
    leg.early = true;
    leg.last_stance_W = foot_W;
  }
  leg.swinging = swing && !leg.early;
  if (!swing && leg.contact) leg.last_stance_W = foot_W;
}

}  // namespace

PerLeg<LegContact> initial_contacts(const PerLeg<Eigen::Vector3d>& foot_W) {
  PerLeg<LegContact> legs;
  for (std::size_t i = 0; i < leg_count; ++i) {
    legs[i].lift_off_W = foot_W[i];
    legs[i].last_stance_W = foot_W[i];
  }
  return legs;
}

void update_contacts(const ContactConfig& config, const Gait& gait, const PerLeg<double>& touch,
                     const PerLeg<Eigen::Vector3d>& foot_W, const PerLeg<bool>& on_ground, PerLeg<LegContact>& legs) {
  for (std::size_t i = 0; i < leg_count; ++i) {
    const bool swing = !gait.scheduled_stance(i);
    const double progress = swing ? gait.swing_progress(i) : 0.0;
    update_leg(config, swing, progress, touch[i], on_ground[i], foot_W[i], legs[i]);
  }
}

}  // namespace plumbline::sim
