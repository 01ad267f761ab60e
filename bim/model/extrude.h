// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "bim/geometry/polygon_boolean.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// Places a point of the flat region in W.
using Placement = std::function<Eigen::Vector3d(const Eigen::Vector2d&)>;

/// Solid between two images of a flat region: caps at `low` and `high`, ruled rims between them. `high` lies on the
/// side from which the region's rings are seen counter-clockwise. Closed by construction, also where rings touch in a
/// point: such a point becomes one vertex for each wedge of the region that meets there.
[[nodiscard]] Solid extrude_between(const Region2& region, const Placement& low, const Placement& high);

/// Extrusion of a region of the xy plane along z, m.
[[nodiscard]] Solid extrude(const Region2& region, double z0_m, double z1_m);

}  // namespace plumbline::bim
