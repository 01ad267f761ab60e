// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/trot/trot.h"

#include <algorithm>
#include <cmath>

namespace plumbline::sim {

Trot::Trot(const TrotConfig& config, const BodyState& state, double mass, double step_s)
    : config_(config),
      mass_(mass),
      step_s_(step_s),
      reference_(config.command, state.X_WR),
      gait_(config.gait),
      legs_(initial_contacts(posture_of(state).foot_W)),
      plane_(config.posture),
      posture_(config.posture),
      distribution_(config.force) {}

Torques Trot::update(const BodyState& state, const Command& command, const Terrain& terrain) {
  const Posture posture = posture_of(state);
  reference_.update(command, state.X_WR, step_s_);
  gait_.update(gait_demand(state, command), step_s_);
  PerLeg<bool> on_ground{};
  for (std::size_t leg = 0; leg < leg_count; ++leg)
    on_ground[leg] =
        legs_[leg].scheduled_swing && at_ground_level(config_.contact, terrain, state.X_WR.t.z(), posture.foot_W[leg]);
  update_contacts(config_.contact, gait_, state.touch, posture.foot_W, on_ground, legs_);
  plan_footholds(state, posture, terrain);
  plane_.update(legs_, step_s_);
  change_height();

  PerLeg<Eigen::Vector3d> lever_W;
  PerLeg<double> fz_max;
  for (std::size_t leg = 0; leg < leg_count; ++leg) {
    lever_W[leg] = posture.foot_W[leg] - Eigen::Vector3d(0.0, 0.0, robot_dimensions.foot_radius) - state.com_W;
    fz_max[leg] = force_limit(leg);
  }
  const Wrench wrench = desired_wrench(posture_, state, reference_, plane_, mass_);
  const PerLeg<Eigen::Vector3d> force_W = distribution_.solve(wrench, lever_W, fz_max);

  Torques torques{};
  for (std::size_t leg = 0; leg < leg_count; ++leg) {
    const Eigen::Vector3d torque =
        fz_max[leg] > 0.0
            ? Eigen::Vector3d(-posture.jacobian_R[leg].transpose() * (state.X_WR.q.conjugate() * force_W[leg]) +
                              state.bias[leg] - config_.force.joint_damping * state.qd[leg])
            : swing_torque(config_.swing, state, posture, foot_target(posture, leg), leg);
    std::copy_n(torque.data(), 3, torques.data() + 3 * leg);
  }
  ++steps_;
  return torques;
}

void Trot::change_height() {
  const PostureConfig& c = config_.posture;
  const double step = c.height_rate * step_s_;
  const double target = gait_.slow_gait() ? c.slow_height_m : c.height_m;
  posture_.height_m += std::clamp(target - posture_.height_m, -step, step);
}

GaitDemand Trot::gait_demand(const BodyState& state, const Command& command) const {
  const GaitConfig& c = config_.gait;
  const double commanded = std::abs(command.vx) + std::abs(command.vy) + std::abs(command.yaw_rate);
  const Eigen::Vector2d off_W = (state.v_W - reference_.v_W()).head<2>();
  const Eigen::Vector2d lean_W = (state.com_W - stance_center(legs_)).head<2>();
  GaitDemand demand;
  demand.still = commanded < c.still_command && reference_.speed() < c.still_speed &&
                 std::abs(reference_.yaw_rate()) < c.still_speed;
  demand.disturbed = off_W.norm() > c.disturbed_speed || lean_W.norm() > c.disturbed_com_offset_m;
  demand.period_scale = command.gait_period_scale;
  demand.slow_gait = command.slow_gait;
  return demand;
}

void Trot::plan_footholds(const BodyState& state, const Posture& posture, const Terrain& terrain) {
  const bool replan = steps_ % config_.foothold.replan_steps == 0;
  for (std::size_t leg = 0; leg < leg_count; ++leg) {
    if (!legs_[leg].swinging) continue;
    const bool open = gait_.swing_progress(leg) <
                      (swing_[leg].steps ? config_.foothold.freeze_steps_after : config_.foothold.freeze_after);
    if (!legs_[leg].lifted_off)
      wait_for_height(config_.swing, terrain, state.X_WR.t.z(), posture.foot_W[leg], step_s_ / gait_.swing_s(),
                      swing_[leg]);
    if (!legs_[leg].lifted_off && !(replan && open)) continue;
    const Eigen::Vector3d& from_W = legs_[leg].lift_off_W;
    const Eigen::Vector3d to_W = foothold(config_.foothold, gait_, state, reference_, terrain, leg);
    const double z_max = state.X_WR.t.z();
    const bool steps = legs_[leg].lifted_off ? over_steps(config_.swing, terrain, z_max, from_W, to_W)
                                             : swing_[leg].steps;  // a change under way would make the foot jump
    const double waited = legs_[leg].lifted_off ? 0.0 : swing_[leg].across_from;
    swing_[leg] = swing_path(config_.swing, terrain, z_max, from_W, to_W, steps);
    swing_[leg].across_from = std::max(swing_[leg].across_from, waited);
  }
}

double Trot::force_limit(std::size_t leg) const {
  const ForceConfig& c = config_.force;
  if (legs_[leg].swinging || !legs_[leg].contact) return 0.0;
  if (gait_.standing() || legs_[leg].early) return c.fz_max_n;
  const double after = c.ramp_start + gait_.since_stance_start_s(leg) / c.ramp_s;
  const double before = gait_.until_stance_end_s(leg) / c.ramp_s;
  return c.fz_max_n * std::max(c.ramp_floor, std::min({1.0, after, before}));
}

FootTarget Trot::foot_target(const Posture& posture, std::size_t leg) const {
  if (legs_[leg].swinging) return swing_point(config_.swing, swing_[leg], gait_.swing_progress(leg), gait_.swing_s());
  const ContactConfig& c = config_.contact;
  const double rate = gait_.slow_gait() ? c.slow_push_rate : c.late_push_rate;
  return {posture.foot_W[leg] - Eigen::Vector3d(0.0, 0.0, c.late_push_m),
          Eigen::Vector3d(0.0, 0.0, -c.late_push_m * rate)};
}

}  // namespace plumbline::sim
