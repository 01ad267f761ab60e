// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "bim/formats/plan_yaml/deviations.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// What a plan leaves open about the solids it stands for, m.
struct PlanSolids {
  double slab_m = 0.2;            ///< thickness of floor and ceiling
  int cylinder_sides = 32;        ///< of round clutter
  double room_overlap_m2 = 0.01;  ///< rooms of one storey may share this much
  double room_remnant_m2 = 0.5;   ///< a piece this large that walls cut off a room is no corner of it
};

/// A plan and what was built of it.
struct PlanSite {
  Building as_planned;
  AsBuilt as_built;
};

/// Reads a building, as planned, from a file of kind `plan: 1`. Rooms become the clear outline within their walls;
/// every storey gets a floor and a ceiling over its walls and rooms. Throws InputError at the offending line.
[[nodiscard]] Building read_plan(const std::string& path);
/// The same from text; `file` names it in errors. Deviations are checked.
[[nodiscard]] Building read_plan_text(std::string_view text, const std::string& file, const PlanSolids& solids = {});
/// The same with its deviations built.
[[nodiscard]] PlanSite read_plan_site(std::string_view text, const std::string& file, const PlanSolids& solids = {});

}  // namespace plumbline::bim
