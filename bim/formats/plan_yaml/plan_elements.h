// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "bim/formats/plan_yaml/plan_entries.h"
#include "bim/furniture/shapes.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// The storey that entries of a plan are built on.
struct PlanLevel {
  int index = 0;       ///< into Building::storeys
  std::string prefix;  ///< of the ids of a copied storey
  double floor_z_m = 0.0;
  double top_z_m = 3.0;
};

[[nodiscard]] Wall wall_of(const PlanWallEntry& entry, const PlanLevel& level);
/// `wall` has the index `wall_index`.
[[nodiscard]] Opening opening_of(const PlanOpeningEntry& entry, const std::string& prefix, int wall_index,
                                 const Wall& wall);
[[nodiscard]] Column column_of(const PlanColumnEntry& entry, const PlanLevel& level);
/// The furniture that a shape is; none for a box or cylinder.
[[nodiscard]] std::optional<FurnitureShape> furniture_of(ClutterShape shape);
[[nodiscard]] ClutterShape clutter_shape_of(FurnitureShape shape);
/// Of kind box, cylinder or furniture. Round clutter has its corners, so many, on the ellipse.
[[nodiscard]] Obstacle clutter_of(const PlanClutterEntry& entry, const PlanLevel& level, int cylinder_sides);

}  // namespace plumbline::bim
