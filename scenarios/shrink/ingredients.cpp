// SPDX-License-Identifier: Apache-2.0
#include "scenarios/shrink/ingredients.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "scenarios/spec/dotted_key.h"
#include "scenarios/spec/scenario.h"

namespace plumbline::scenarios {

namespace {

std::string text_of_value(const Tree& value) { return write_json(value, 0); }

Scenario read(const Tree& scenario) { return read_scenario(write_yaml(scenario), "scenario.yaml").scenario; }

/// The simplest value of every key that can be simpler.
Tree simplest() {
  Scenario scenario;
  scenario.lidar.preset = sim::LidarPreset::ideal;
  scenario.odometry.preset = sim::OdometryPreset::ideal;
  scenario.ground.uneven_mm = 0.0;
  scenario.pushes.max_n = 0.0;
  scenario.prior = {Knowledge::known, Knowledge::known};
  return to_tree(scenario);
}

void add_entries(const Tree& scenario, const std::string& key, std::vector<Ingredient>& all) {
  const Tree* list = scenario.find(key);
  if (list == nullptr || !list->is_list()) return;
  for (std::size_t i = 0; i < list->as_list().size(); ++i)
    all.push_back({key + " " + std::to_string(i + 1), key, i, std::nullopt});
}

/// Of a switch or size that replaces one of a preset.
bool is_off(const Tree& value) {
  const std::string text = text_of_value(value);
  return text == "false" || text == "0" || text == "\"none\"";
}

/// Keys of a block that differ from the simplest; those that the simplest leaves out go.
void add_block(const Tree& scenario, const std::string& key, const Tree& usual, std::vector<Ingredient>& all) {
  const Tree* block = scenario.find(key);
  if (block == nullptr || !block->is_map()) return;
  for (const auto& [name, value] : block->as_map()) {
    const std::string path = key + "." + name;
    const Tree* other = find_at(usual, path);
    if (other != nullptr ? text_of_value(*other) == text_of_value(value) : is_off(value)) continue;
    const std::string shown = value.is_scalar() ? ": " + flow_text(value) : "";
    all.push_back({path + shown, path, std::nullopt, other != nullptr ? std::optional(*other) : std::nullopt});
  }
}

void add_key(const Tree& scenario, const std::string& key, const std::optional<Tree>& value,
             std::vector<Ingredient>& all) {
  const Tree* own = find_at(scenario, key);
  if (own == nullptr || (value && text_of_value(*own) == text_of_value(*value))) return;
  all.push_back({key + (own->is_scalar() ? ": " + flow_text(*own) : ""), key, std::nullopt, value});
}

/// A part of a preset and what switches it off.
struct Effect {
  std::string_view key;
  bool on = false;
  Tree off;
};

void add_effects(const Tree& scenario, const std::vector<Effect>& effects, std::vector<Ingredient>& all) {
  for (const Effect& effect : effects)
    if (effect.on && find_at(scenario, std::string(effect.key)) == nullptr)
      all.push_back({std::string(effect.key), std::string(effect.key), std::nullopt, effect.off});
}

}  // namespace

std::vector<Ingredient> ingredients_of(const Tree& tree) {
  const Tree scenario = to_tree(read(tree)), usual = simplest();  // every key is there, with a value of its own type
  std::vector<Ingredient> all;
  add_entries(scenario, "people", all);
  add_entries(scenario, "moving_doors", all);
  add_key(scenario, "kidnap", std::nullopt, all);
  add_key(scenario, "pushes.max_n", Tree(0.0), all);
  Tree no_faults = Tree::map();
  no_faults.set("faults", Tree::map().set("preset", "none"));
  add_block(scenario, "faults", no_faults, all);
  for (const char* block : {"ground", "world", "plan", "lidar", "odometry", "prior"})
    add_block(scenario, block, usual, all);
  add_key(scenario, "furnish", std::nullopt, all);
  add_key(scenario, "doors", *usual.find("doors"), all);
  return all;
}

std::vector<Ingredient> effects_of(const Tree& scenario) {
  const Scenario read_back = read(scenario);
  std::vector<Ingredient> all;
  const sim::LidarConfig lidar = lidar_config(read_back.lidar);
  const Tree off(false), none(0.0);
  add_effects(scenario,
              {{"lidar.range_noise", lidar.range_noise, off},
               {"lidar.unit_bias", lidar.unit_bias, off},
               {"lidar.laser_bias", lidar.laser_bias, off},
               {"lidar.reflectivity_noise", lidar.reflectivity_noise, off},
               {"lidar.dropout", lidar.dropout, off},
               {"lidar.optics", lidar.optics, off},
               {"lidar.footprint", lidar.footprint != sim::Footprint::none, Tree("none")},
               {"lidar.distance_bias_m", lidar.distance_bias_m != 0.0, none},
               {"lidar.reflectivity_bias_m", lidar.reflectivity_bias_m != 0.0, none},
               {"lidar.incidence_bias_m", lidar.incidence_bias_m != 0.0, none},
               {"lidar.warm_up_m", lidar.warm_up_m != 0.0, none},
               {"lidar.airborne_per_m", lidar.airborne_per_m != 0.0, none}},
              all);
  if (!read_back.faults || read_back.faults->preset == sim::FaultsPreset::none) return all;
  add_effects(scenario,
              {{"faults.clock_offset_s", true, none},
               {"faults.clock_jitter_s", true, none},
               {"faults.mount_error_m", true, none},
               {"faults.mount_error_deg", true, none},
               {"faults.gyro_bias_radps", true, none},
               {"faults.accelerometer_bias", true, none},
               {"faults.imu_scale", true, none},
               {"faults.slip_mps", true, none}},
              all);
  return all;
}

bool is_left(const Ingredient& ingredient, const Tree& before, const Tree& after) {
  const Tree *was = find_at(before, ingredient.key), *is = find_at(after, ingredient.key);
  if (was == nullptr || is == nullptr) return was == is;
  if (!ingredient.entry) return text_of_value(*was) == text_of_value(*is);
  const std::string text = text_of_value(was->as_list()[*ingredient.entry]);
  return std::any_of(is->as_list().begin(), is->as_list().end(),
                     [&](const Tree& entry) { return text_of_value(entry) == text; });
}

Tree with_ingredients(Tree scenario, const std::vector<Ingredient>& ingredients, const Kept& kept) {
  // From the last on, so that the entries of a list keep their places until it is their turn.
  for (std::size_t i = ingredients.size(); i-- > 0;) {
    if (std::binary_search(kept.begin(), kept.end(), i)) continue;
    const Ingredient& gone = ingredients[i];
    if (gone.entry) {
      Tree::List list = find_at(scenario, gone.key)->as_list();
      list.erase(list.begin() + static_cast<std::ptrdiff_t>(*gone.entry));
      set_at(scenario, gone.key, Tree(std::move(list)));
    } else if (gone.value) {
      set_at(scenario, gone.key, *gone.value);
    } else {
      erase_at(scenario, gone.key);
    }
  }
  const Tree* faults = scenario.find("faults");
  if (faults != nullptr && text_of_value(*faults) == R"({"preset":"none"})") erase_at(scenario, "faults");
  return scenario;
}

}  // namespace plumbline::scenarios
