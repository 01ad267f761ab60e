// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/geometry/polygon_boolean.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// The material of a closed body at the height z in W, m, on the plan. Rings that do not close are left out, so the
/// section of an open body may be empty.
[[nodiscard]] Region2 body_section(const Solid& body, double z_m);

/// The material of a wall at the height z in W, m, on the plan: of its uncut body, or of the rectangle without one or
/// where the body has no section there. Does not look at the wall's heights.
[[nodiscard]] Region2 wall_section(const Wall& wall, double z_m);

/// Share of its rectangle on the plan that the wall's body fills where it fills most, since a gable is short at the
/// top; 1 without a body.
[[nodiscard]] double fill_of(const Wall& wall);

}  // namespace plumbline::bim
