// SPDX-License-Identifier: Apache-2.0
#include "bim/model/materials.h"

#include <algorithm>

namespace plumbline::bim {

const std::vector<Material>& preset_materials() {
  // Round figures of ours for near infrared light (905 nm): reflectivity is the diffuse share only.
  static const std::vector<Material> presets = {
      {"black", 0.05, 0.0, 0.0},  {"concrete", 0.4, 0.0, 0.0}, {"glass", 0.001, 0.85, 0.08}, {"metal", 0.3, 0.0, 0.4},
      {"mirror", 0.03, 0.0, 0.9}, {"plaster", 0.7, 0.0, 0.0},  {"sign", 0.3, 0.0, 0.0, 0.3}, {"wood", 0.5, 0.0, 0.0},
  };
  return presets;
}

const Material* find_material(const Building& building, std::string_view id) {
  const auto named = [&](const Material& material) { return material.id == id; };
  const auto own = std::find_if(building.materials.begin(), building.materials.end(), named);
  if (own != building.materials.end()) return &*own;
  const std::vector<Material>& presets = preset_materials();
  const auto preset = std::find_if(presets.begin(), presets.end(), named);
  return preset == presets.end() ? nullptr : &*preset;
}

void use_material(Building& building, const std::string& id) {
  const Material* material = find_material(building, id);
  const auto same = [&](const Material& other) { return other.id == id; };
  if (material == nullptr || std::any_of(building.materials.begin(), building.materials.end(), same)) return;
  building.materials.push_back(*material);
}

bool is_see_through(const Building& building, std::string_view material) {
  const Material* found = find_material(building, material);
  return found != nullptr && found->transmission >= see_through_share;
}

}  // namespace plumbline::bim
