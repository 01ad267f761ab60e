// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bim/errors.h"
#include "bim/formats/plan_yaml/plan_write.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/generators/generators.h"

namespace plumbline::bim {

/// A generated building and how it was asked for.
struct SweepCase {
  std::string what;
  GeneratedPlan generated;
  Building building;
};

/// The k-th building of a sweep over families, features, sizes of the feature, sight and seeds; absent where its
/// feature has no place.
inline std::optional<SweepCase> sweep_case(std::uint64_t k) {
  constexpr std::array<const char*, 6> features = {"door_shift", "wall_shift", "niche", "window", "column", "clutter"};
  constexpr std::array<double, 7> epsilons = {0.0, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5};
  const std::string family(generators()[k % generators().size()].name);
  const std::uint64_t round = k / generators().size();
  const double epsilon = epsilons[round % epsilons.size()];
  Tree options = Tree::map();
  options.set("seed", std::to_string(k));
  if (epsilon > 0.0) {
    options.set("epsilon_m", epsilon).set("feature", features[(round + k) % features.size()]);
    options.set("feature_visible", (round / 2 + k) % 2 == 0 ? "true" : "false");
  }
  if (round % 5 == 4) options.set("glass", "true");
  try {
    SweepCase result{family + " " + write_json(options, 0), generate(family, options), {}};
    result.building = read_plan_text(write_plan(result.generated.plan), "generated");
    return result;
  } catch (const InputError& error) {
    if (std::string(error.what()).find("no position") == std::string::npos) throw;
    return std::nullopt;
  }
}

}  // namespace plumbline::bim
