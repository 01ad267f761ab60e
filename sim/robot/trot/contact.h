// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/robot/trot/gait.h"

namespace plumbline::sim {

/// One leg between the gait's schedule and the ground, docs/methods/robot.md.
struct LegContact {
  bool contact = true;      ///< touch force with hysteresis
  bool early = false;       ///< touched down before the end of its swing
  bool swinging = false;    ///< moves through the air: scheduled swing and not early
  bool lifted_off = false;  ///< its swing began at this step
  bool scheduled_swing = false;
  Eigen::Vector3d lift_off_W = Eigen::Vector3d::Zero();     ///< foot centre when the swing began
  Eigen::Vector3d last_stance_W = Eigen::Vector3d::Zero();  ///< foot centre when it last stood
};

/// All four legs, standing on their feet.
[[nodiscard]] PerLeg<LegContact> initial_contacts(const PerLeg<Eigen::Vector3d>& foot_W);

/// One step of the contact logic of all legs; on_ground: the sole is
/// at the height of ground.
void update_contacts(const ContactConfig& config, const Gait& gait, const PerLeg<double>& touch,
                     const PerLeg<Eigen::Vector3d>& foot_W, const PerLeg<bool>& on_ground, PerLeg<LegContact>& legs);

}  // namespace plumbline::sim
