// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bim/model/building.h"

namespace plumbline::bim {

/// A LiDAR hardly detects a material that transmits this share of the light, except at normal incidence: predicted
/// scans and symmetries leave it out.
inline constexpr double see_through_share = 0.5;

/// Materials that a plan may name without declaring them; its own of the same id goes before.
[[nodiscard]] const std::vector<Material>& preset_materials();
/// The building's material of this id, a preset, or nullptr.
[[nodiscard]] const Material* find_material(const Building& building, std::string_view id);
/// Adds the preset of this id to a building that has no material of that id; nothing for the empty id.
void use_material(Building& building, const std::string& id);
/// True when the material is transparent to a LiDAR; an unknown one is opaque.
[[nodiscard]] bool is_see_through(const Building& building, std::string_view material);

}  // namespace plumbline::bim
