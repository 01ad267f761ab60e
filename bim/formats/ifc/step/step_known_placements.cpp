// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_known_placements.h"

#include <map>
#include <string_view>
#include <utility>

#include "bim/formats/ifc/step/step_entities.h"

namespace plumbline::bim {
namespace {

using Kind = StepValue::Kind;

constexpr std::string_view linear_type = "IFCLINEARPLACEMENT", grid_type = "IFCGRIDPLACEMENT";

std::string argument(const StepValue& value) {
  return value.kind == Kind::reference ? "#" + std::to_string(value.as_reference()) : "$";
}

bool is_reference_to(const StepEntities& entities, const StepValue& value, std::string_view ending) {
  return value.kind == Kind::reference && entities.entity(value.as_reference()).type.ends_with(ending);
}

/// What a placement is in IFC4; empty where it is that already.
std::string known(const StepEntities& entities, const StepEntities::Entity& entity) {
  if (entity.type != linear_type && entity.type != grid_type) return {};
  const StepValue values = entities.attributes(entity);
  const std::vector<StepValue>& items = values.as_list();
  if (entity.type == grid_type) {
    if (items.size() != 3) return {};
    return std::string(grid_type) + "(" + argument(items[1]) + "," + argument(items[2]) + ")";
  }
  // The fallback is the last attribute in IFC4X1 to IFC4X3; in IFC4X1 the first is a curve.
  if (items.empty() || !is_reference_to(entities, items.back(), "AXIS2PLACEMENT3D"))
    return std::string(grid_type) + "($,$)";
  const bool in_parent = is_reference_to(entities, items.front(), "PLACEMENT");
  return "IFCLOCALPLACEMENT(" + (in_parent ? argument(items.front()) : "$") + "," + argument(items.back()) + ")";
}

/// Where the entity's closing bracket is behind its first, which stands at `open`.
std::size_t closing(std::string_view text, std::size_t open) {
  int depth = 0;
  for (std::size_t at = open; at < text.size(); ++at) {
    if (text[at] == '\'') at = text.find('\'', at + 1);
    if (at >= text.size()) break;
    if (text[at] == '(') ++depth;
    if (text[at] == ')' && --depth == 0) return at;
  }
  return text.size() - 1;
}

}  // namespace

std::string with_known_placements(const std::string& text, const std::string& file) {
  if (text.find(linear_type) == std::string::npos && text.find(grid_type) == std::string::npos) return text;
  const StepEntities entities(text, file);
  std::map<std::size_t, std::pair<std::size_t, std::string>> edits;  // end and new text by begin
  for (const StepEntities::Entity& entity : entities.all()) {
    std::string replacement = known(entities, entity);
    if (replacement.empty()) continue;
    const auto begin = static_cast<std::size_t>(entity.type.data() - text.data());
    const auto open = static_cast<std::size_t>(entity.attributes.data() - text.data());
    edits[begin] = {closing(text, open) + 1, std::move(replacement)};
  }
  std::string result;
  std::size_t done = 0;
  for (const auto& [begin, edit] : edits) {
    result.append(text, done, begin - done).append(edit.second);
    done = edit.first;
  }
  return result.append(text, done, std::string::npos);
}

}  // namespace plumbline::bim
