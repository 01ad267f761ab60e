// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bim/config/tree.h"
#include "scenarios/shrink/ddmin.h"

namespace plumbline::scenarios {

/// Something of a scenario that a simpler one does not have: a person, a fault, a noise, an unknown heading.
struct Ingredient {
  std::string name;                  ///< as a user would say it: "people 2", "faults.slip_mps"
  std::string key;                   ///< dotted
  std::optional<std::size_t> entry;  ///< of the list at `key`: this one goes
  std::optional<Tree> value;         ///< that replaces it; neither: the key goes
};

/// Everything of a resolved scenario that is not as in the simplest walk: ideal sensors on an even floor, nobody about,
/// built as planned, heading and storey known. A preset of noise is one of them.
[[nodiscard]] std::vector<Ingredient> ingredients_of(const Tree& scenario);
/// The parts of the presets of noise that a scenario has, and which it can be without.
[[nodiscard]] std::vector<Ingredient> effects_of(const Tree& scenario);

/// Whether an ingredient of `before`, or an effect of a preset of it, is still as it was in a scenario made of it.
[[nodiscard]] bool is_left(const Ingredient& ingredient, const Tree& before, const Tree& after);

/// The scenario with these of its ingredients only.
[[nodiscard]] Tree with_ingredients(Tree scenario, const std::vector<Ingredient>& ingredients, const Kept& kept);

}  // namespace plumbline::scenarios
