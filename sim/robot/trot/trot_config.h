// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace plumbline::sim {

/// Gait, command shaping and contact logic, docs/methods/robot.md.
struct GaitConfig {
  double period_s = 0.44;
  double duty = 0.56;           ///< share of the period in stance
  double slow_period_s = 0.70;  ///< of the slow gait, for stairs
  double slow_duty = 0.70;
  double still_command = 1e-3;           ///< |vx| + |vy| + |yaw rate| below: commanded to stand
  double still_speed = 0.02;             ///< m/s and rad/s of the slewed command
  double disturbed_speed = 0.25;         ///< m/s off the desired velocity: step even when commanded to stand
  double disturbed_com_offset_m = 0.10;  ///< centre of mass from the middle of the feet
  double settle_time_s = 1.0;            ///< still for so long before the trot stops
};

struct CommandConfig {
  double acceleration = 1.2;         ///< m/s^2
  double yaw_acceleration = 2.5;     ///< rad/s^2
  double yaw_lag_max = 0.25;         ///< rad, yaw reference from the robot's yaw
  double position_lag_max_m = 0.08;  ///< position reference from the robot
};

struct ContactConfig {
  double on_n = 8.0;             ///< N, touch force
  double off_n = 2.0;            ///< N
  double early_after = 0.5;      ///< part of the swing after which a contact ends it,
  double early_off_m = 0.03;     ///< if the sole is so close to the level of the ground
  double early_near_m = 0.05;    ///< under it or so far beside it: else it is the face of a step
  double late_push_m = 0.01;     ///< a foot without expected contact aims so far below itself
  double late_push_rate = 10.0;  ///< 1/s: downward speed is late_push_m times this,
  double slow_push_rate = 60.0;  ///< and this where the tread may be far below
};

struct FootholdConfig {
  double velocity_gain_s = 0.10;  ///< kv
  double offset_max_m = 0.25;
  double pendulum_height_m = 0.50;  ///< h of the turning term
  double below_ground_m = 0.006;    ///< aims into the ground, to be sure of contact
  int replan_steps = 5;             ///< 10 ms
  double freeze_after = 0.8;        ///< part of the swing
  double freeze_steps_after = 0.6;  ///< the same over steps: a foot cannot change to another tread
  double search_step_m = 0.03;      ///< other places are tried in this grid
  int search_along = 5;             ///< so many to each side along the heading,
  int search_across = 1;            ///< and across it
  double probe_m = 0.055;           ///< a foothold is rough when the ground so far from it
  double rough_m = 0.03;            ///< is so much higher or lower
  double rough_cost_m2 = 0.05;      ///< more than any place of the search is away
};

struct SwingConfig {
  double clearance_m = 0.07;
  double apex_at = 0.5;           ///< part of the swing
  int way_points = 5;             ///< ground samples between lift-off and target
  double over_ground_m = 0.05;    ///< sole above them at the apex
  double steps_m = 0.03;          ///< ground that differs by more along the way is stepped over as stairs are:
  double step_m = 0.05;           ///< a target higher or lower by more
  double apex_up_at = 0.45;       ///< has its apex here
  double apex_down_at = 0.55;     ///< or here,
  double across_from = 0.12;      ///< and the foot moves across from here
  double across_to = 0.88;        ///< to here, part of the swing;
  double up_across_from = 0.25;   ///< upwards from here
  double up_across_to = 0.95;     ///< to here
  double ahead_m = 0.06;          ///< while the ground so far ahead is too high for it the foot waits,
  double wait_rate = 2.0;         ///< part of the swing lost a part waited
  double across_latest = 0.6;     ///< but not beyond here
  double kp = 300.0;              ///< N m/rad
  double kd = 9.0;                ///< N m s/rad
  double joint_speed_max = 20.0;  ///< rad/s
  double damping = 1e-3;          ///< of the pseudo-inverse of the Jacobian
};

struct PostureConfig {
  double height_m = 0.50;
  double slow_height_m = 0.45;  ///< with the slow gait: legs that are bent more reach down farther
  double height_rate = 0.1;     ///< m/s, from one to the other
  double normal_time_constant_s = 0.15;
  double plane_damping = 1e-4;       ///< on the diagonal of the plane fit
  double kp_xy = 20.0, kd_xy = 8.0;  ///< 1/s^2, 1/s
  double kp_z = 120.0, kd_z = 16.0;
  double kp_tilt = 140.0, kd_tilt = 16.0;
  double kp_yaw = 40.0, kd_yaw = 10.0;
  double inertia_roll = 0.9, inertia_pitch = 2.6, inertia_yaw = 3.0;  ///< kg m^2
  double horizontal_max_g = 0.6;                                      ///< horizontal force, in robot weights
  double vertical_min_g = 0.3, vertical_max_g = 2.0;
};

struct ForceConfig {
  double friction = 0.6;  ///< assumed by the controller
  double alpha = 1e-5;    ///< weight of |f|^2
  double beta = 3e-5;     ///< weight of |f - f_previous|^2
  double rho = 1e-3;      ///< ADMM penalty
  int iterations = 40;    ///< fixed, so that cost and result are deterministic
  double fz_min_n = 10.0, fz_max_n = 450.0;
  double ramp_s = 0.030;  ///< around touchdown and lift-off
  double ramp_start = 0.3, ramp_floor = 0.05;
  double joint_damping = 0.5;  ///< N m s/rad of a stance leg
};

struct TrotConfig {
  GaitConfig gait;
  CommandConfig command;
  ContactConfig contact;
  FootholdConfig foothold;
  SwingConfig swing;
  PostureConfig posture;
  ForceConfig force;
};

inline constexpr double gravity = 9.81;  ///< m/s^2

}  // namespace plumbline::sim
