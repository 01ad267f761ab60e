// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "bim/formats/plan_yaml/deviations.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// Dimensions of solids that a plan does not give, m.
struct PlanSolids {
  double slab_m = 0.2;            ///< thickness of floor and ceiling
  int cylinder_sides = 32;        ///< of round clutter
  double room_overlap_m2 = 0.01;  ///< rooms of one storey may share this much
  double room_remnant_m2 = 0.5;   ///< a piece this large that walls cut off a room is no corner of it
};

/// A building as planned and as built.
struct PlanWithDeviations {
  Building as_planned;
  AsBuilt as_built;
};

/// Reads a building, as planned, from the text of a file of kind `plan: 1`; `file` names it in errors. Rooms become the
/// clear outline within their walls; every storey gets a floor and a ceiling over its walls and rooms. Deviations are
/// checked. Throws InputError at the offending line.
[[nodiscard]] Building read_plan_text(std::string_view text, const std::string& file, const PlanSolids& solids = {});
/// The same with the deviations applied.
[[nodiscard]] PlanWithDeviations read_plan_with_deviations(std::string_view text, const std::string& file,
                                                           const PlanSolids& solids = {});

}  // namespace plumbline::bim
