// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/plan/plan.h"
#include "slam/plan_map/plan_index.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam::synthetic {

/// The plan of a house of boxes: four faces a box, rooms r0, r1, ...; one storey "ground".
[[nodiscard]] bim::Plan plan_of(const House& house);
/// The first storey of a plan, with few rays for what is visible.
[[nodiscard]] StoreyIndex storey_of(const bim::Plan& plan);
/// The plan moved by X_VW, a rotation about z and a translation.
[[nodiscard]] bim::Plan moved(const bim::Plan& plan_W, const Pose& X_VW);
/// Two closed rooms exactly alike, side by side.
[[nodiscard]] House twin_rooms();

}  // namespace plumbline::slam::synthetic
