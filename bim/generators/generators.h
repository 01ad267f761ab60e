// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bim/formats/plan_yaml/plan_file.h"
#include "bim/generators/options.h"

namespace plumbline::bim {

struct GeneratorRow {
  std::string_view name;
  std::string_view summary;
};

/// The generators of families of stress buildings, in the order they are listed.
[[nodiscard]] std::span<const GeneratorRow> generators();

struct OptionRow {
  std::string key;    ///< as in the options' visit
  std::string value;  ///< default, empty for none
  std::string doc;
  std::string choices;  ///< of an enumeration or bool, "a | b", else empty
  std::string type;     ///< "integer" or "number", else empty
};

/// Options of a family with their defaults. InputError for a name that is no family.
[[nodiscard]] std::vector<OptionRow> generator_options(std::string_view family);

/// A stress building as a plan, with its start and rooms.
struct GeneratedPlan {
  PlanFile plan;
  std::string start;               ///< room to start in
  std::vector<std::string> rooms;  ///< rooms of its storey, the start last
};

/// A building of a family. `options` is a map with keys of the family's options; unknown keys, values out of range and
/// combinations that cannot be built are InputErrors at their marks. The same options give the same plan.
[[nodiscard]] GeneratedPlan generate(std::string_view family, const Tree& options);

}  // namespace plumbline::bim
