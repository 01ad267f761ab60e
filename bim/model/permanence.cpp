// SPDX-License-Identifier: Apache-2.0
#include "bim/model/permanence.h"

#include <algorithm>

namespace plumbline::bim {

namespace {

/// Kinds of obstacles that are built in place. IfcCovering is a floor, a ceiling or a cladding.
constexpr std::array<std::string_view, 19> structure_kinds = {
    "door_leaf", "window_pane", "railing", "curtain_panel", "mullion",       "plate",   "member",
    "beam",      "covering",    "part",    "ramp",          "stair",         "footing", "pile",
    "roof",      "slab",        "column",  "chimney",       "shading_device"};
/// A proxy may stand for anything.
constexpr std::array<std::string_view, 8> furniture_kinds = {"box",
                                                             "cylinder",
                                                             "furniture",
                                                             "proxy",
                                                             "electric_appliance",
                                                             "element_assembly",
                                                             "mobile_telecommunications_appliance",
                                                             "audio_visual_appliance"};

bool is_one_of(std::string_view kind, auto kinds) { return std::find(kinds.begin(), kinds.end(), kind) != kinds.end(); }

}  // namespace

Permanence permanence_of(const Obstacle& obstacle) {
  if (!obstacle.planned) return Permanence::clutter;
  if (is_one_of(obstacle.kind, structure_kinds)) return Permanence::structure;
  return is_one_of(obstacle.kind, furniture_kinds) ? Permanence::furniture : Permanence::fixed;
}

bool may_have_moved(const Obstacle& obstacle) { return permanence_of(obstacle) >= Permanence::furniture; }

bool is_gone(const Obstacle& planned, const Building& as_built) {
  return std::none_of(as_built.obstacles.begin(), as_built.obstacles.end(),
                      [&](const Obstacle& obstacle) { return obstacle.id == planned.id; });
}

}  // namespace plumbline::bim
