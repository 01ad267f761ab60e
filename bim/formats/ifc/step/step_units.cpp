// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_units.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace plumbline::bim {
namespace {

using Kind = StepValue::Kind;

constexpr std::array<std::pair<std::string_view, double>, 16> prefixes{{{"EXA", 1e18},
                                                                        {"PETA", 1e15},
                                                                        {"TERA", 1e12},
                                                                        {"GIGA", 1e9},
                                                                        {"MEGA", 1e6},
                                                                        {"KILO", 1e3},
                                                                        {"HECTO", 1e2},
                                                                        {"DECA", 1e1},
                                                                        {"DECI", 1e-1},
                                                                        {"CENTI", 1e-2},
                                                                        {"MILLI", 1e-3},
                                                                        {"MICRO", 1e-6},
                                                                        {"NANO", 1e-9},
                                                                        {"PICO", 1e-12},
                                                                        {"FEMTO", 1e-15},
                                                                        {"ATTO", 1e-18}}};

/// Length of a named unit of a kind; nullopt for those of others.
std::optional<double> unit_of(const StepEntities& entities, const StepValue& reference, std::string_view kind,
                              int depth = 0) {
  constexpr int most_deep = 8;
  const StepEntities::Entity& entity = entities.entity(reference.as_reference());
  const bool si = entity.type == "IFCSIUNIT";
  if ((!si && !entity.type.starts_with("IFCCONVERSIONBASEDUNIT")) || depth > most_deep) return std::nullopt;
  const StepValue values = entities.attributes(entity);
  if (values.at(1).kind != Kind::enumeration || values.at(1).text != kind) return std::nullopt;
  if (!si) {
    const StepValue measure = entities.attributes(values.at(3), "IFCMEASUREWITHUNIT");
    const StepValue& count = measure.at(0);
    const double value = count.kind == Kind::typed ? count.as_typed().as_number() : count.as_number();
    const std::optional<double> base = unit_of(entities, measure.at(1), kind, depth + 1);
    return base && value > 0.0 ? std::optional(value * *base) : std::nullopt;
  }
  if (values.at(2).kind != Kind::enumeration) return 1.0;
  const auto prefix =
      std::find_if(prefixes.begin(), prefixes.end(), [&](const auto& row) { return row.first == values.at(2).text; });
  return prefix == prefixes.end() ? std::nullopt : std::optional(prefix->second);
}

}  // namespace

std::optional<double> assigned_unit(const StepEntities& entities, std::string_view kind) {
  constexpr std::size_t units_in_context = 8;
  for (const StepEntities::Entity& project : entities.all()) {
    if (project.type != "IFCPROJECT") continue;
    try {
      const StepValue assignment =
          entities.attributes(entities.attributes(project).at(units_in_context), "IFCUNITASSIGNMENT");
      for (const StepValue& unit : assignment.at(0).as_list())
        if (const std::optional<double> found = unit_of(entities, unit, kind)) return found;
    } catch (const InputError&) {  // what makes no sense assigns nothing
    }
  }
  return std::nullopt;
}

}  // namespace plumbline::bim
